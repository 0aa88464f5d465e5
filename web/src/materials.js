// Shaders: faces in the light of the pictures of `quadmend render`, and marks that always face the
// eye. Colours are used as they are written; there is no colour management.
import { Color, DoubleSide, ShaderMaterial } from "three";

/** Faces: a colour for each, and a lamp above the left shoulder. */
export function faceMaterial() {
  return new ShaderMaterial({
    side: DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1.5,
    polygonOffsetUnits: 2,
    vertexShader: `
      attribute vec3 tint;
      varying vec3 vTint;
      varying vec3 vNormal;
      varying vec3 vView;
      void main() {
        vec4 place = modelViewMatrix * vec4(position, 1.0);
        vTint = tint;
        vNormal = normalMatrix * normal;
        vView = -place.xyz;
        gl_Position = projectionMatrix * place;
      }`,
    fragmentShader: `
      varying vec3 vTint;
      varying vec3 vNormal;
      varying vec3 vView;
      void main() {
        vec3 n = length(vNormal) > 0.0 ? normalize(vNormal) : normalize(vView);
        float toward = dot(n, normalize(vView));
        float side = toward < 0.0 ? -1.0 : 1.0;
        n *= side;
        float lamp = max(dot(n, vec3(-0.40, 0.50, 0.77)), 0.0);
        float light = 0.50 + 0.56 * (0.55 * lamp + 0.45 * abs(toward));
        vec3 surface = side < 0.0 ? mix(vTint, vec3(0.80, 0.75, 0.72), 0.8) : vTint;
        gl_FragColor = vec4(surface * min(light, 1.0), 1.0);
      }`,
  });
}

/** Marks: discs (shape 0) and diamonds (shape 1) with a dark rim, rings (shape 2). */
export function markMaterial() {
  return new ShaderMaterial({
    transparent: true,
    uniforms: {
      rim: { value: new Color(0x212529) },
      // World size of a disc, and pixels for a unit of length at distance 1.
      size: { value: 1 },
      scale: { value: 1 },
      ratio: { value: 1 },
    },
    vertexShader: `
      attribute vec3 tint;
      attribute float shape;
      attribute float grow;
      uniform float size;
      uniform float scale;
      uniform float ratio;
      varying vec3 vTint;
      varying float vShape;
      void main() {
        vec4 place = modelViewMatrix * vec4(position, 1.0);
        vTint = tint;
        vShape = shape;
        gl_PointSize = clamp(size * scale / -place.z, 5.0 * ratio, 26.0 * ratio) * grow;
        // Nearer than the faces around, unless the surface is steep.
        place.xyz *= 1.0 - 0.9 * size / length(place.xyz);
        gl_Position = projectionMatrix * place;
      }`,
    fragmentShader: `
      uniform vec3 rim;
      varying vec3 vTint;
      varying float vShape;
      void main() {
        vec2 p = 2.0 * gl_PointCoord - 1.0;
        // Shapes come interpolated, and so not exactly.
        float r = vShape > 0.5 && vShape < 1.5 ? abs(p.x) + abs(p.y) : length(p);
        float soft = fwidth(r);
        if (vShape > 1.5) {
          float ring = smoothstep(0.66 - soft, 0.66, r) * (1.0 - smoothstep(1.0 - soft, 1.0, r));
          if (ring < 0.05) discard;
          gl_FragColor = vec4(vTint, ring);
        } else {
          if (r > 1.0) discard;
          float inner = 1.0 - smoothstep(0.78 - soft, 0.78, r);
          gl_FragColor = vec4(mix(rim, vTint, inner), 1.0 - smoothstep(1.0 - soft, 1.0, r));
        }
      }`,
  });
}

// Elements in one expression.

/** An element with attributes (functions are listeners) and children. */
export function el(name, attributes = {}, children = []) {
  return fill(document.createElement(name), attributes, children);
}

/** The same for drawings. */
export function svg(name, attributes = {}, children = []) {
  return fill(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
}

function fill(element, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(key, value);
    else if (value === true) element.setAttribute(key, "");
    else if (value !== false && value != null) element.setAttribute(key, value);
  }
  element.append(...[children].flat());
  return element;
}

/** A number with a few significant digits, and a true minus sign. */
export function shown(value, digits = 4) {
  if (value == null || Number.isNaN(value)) return "–";
  const text = Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(digits)));
  return text.replace("-", "−");
}

/** A whole number with its sign. */
export function signed(value) {
  return value > 0 ? `+${value}` : shown(value);
}

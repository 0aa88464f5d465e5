// Colours, the same as in the pictures of `quadmend render`; told apart with any colour vision.

export const PLUS = [86, 160, 222];
export const PLUS_MORE = [0, 63, 136];
export const MINUS = [246, 214, 51];
export const MINUS_MORE = [178, 110, 0];
export const T_JUNCTION = [204, 51, 17];
export const UNDEFINED = [170, 170, 170];

const THEMES = {
  light: { paper: 0xffffff, face: [238, 240, 243], edge: 0x5c636b, sharp: 0x000000, boundary: 0x008060 },
  dark: { paper: 0x14171a, face: [112, 118, 126], edge: 0x2b2f35, sharp: 0xffffff, boundary: 0x3fd0a4 },
};

/** What differs between light and dark. */
export function theme() {
  return THEMES[isDark() ? "dark" : "light"];
}

/** Whether the page is dark now. */
export function isDark() {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

/** The colour of an element of this index. */
export function ofIndex(index) {
  if (index > 0) return index > 1 ? PLUS_MORE : PLUS;
  return index < -1 ? MINUS_MORE : MINUS;
}

const VIRIDIS = [
  [68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
  [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37],
];

/** The colour of a value from 0 to 1. */
export function heat(value) {
  if (Number.isNaN(value)) return UNDEFINED;
  const place = Math.min(Math.max(value, 0), 1) * (VIRIDIS.length - 1);
  const below = Math.min(Math.floor(place), VIRIDIS.length - 2);
  return VIRIDIS[below].map((c, i) => c + (place - below) * (VIRIDIS[below + 1][i] - c));
}

/** All colours of the heat map, for a legend. */
export const HEAT_CSS = `linear-gradient(90deg, ${VIRIDIS.map((c) => `rgb(${c})`).join(", ")})`;

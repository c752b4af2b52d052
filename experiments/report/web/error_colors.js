// The colours of errors: blue for none, red for what reaches the end of the scale. They are as light in the middle as
// the light of the scene allows and never as dark as either background.

const stops = [[0.17, 0.42, 0.73], [0.35, 0.68, 0.72], [0.67, 0.85, 0.64], [0.98, 0.95, 0.68], [0.98, 0.7, 0.4],
  [0.92, 0.4, 0.26], [0.7, 0.09, 0.14]];
const unknown = [0.6, 0.6, 0.62];

/** Red, green and blue, 0 to 1, of an error that is `part` of the scale. */
export function errorColor(part) {
  if (Number.isNaN(part)) return unknown;
  const place = Math.min(Math.max(part, 0), 1) * (stops.length - 1);
  const before = Math.min(Math.floor(place), stops.length - 2);
  return stops[before].map((value, i) => value + (place - before) * (stops[before + 1][i] - value));
}

/** The scale from below to above, for CSS. */
export function errorGradient() {
  const css = ([red, green, blue]) => `rgb(${255 * red} ${255 * green} ${255 * blue})`;
  return `linear-gradient(to top, ${stops.map(css).join(", ")})`;
}

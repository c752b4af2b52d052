// Decodes what view_json() wrote: base64 of little-endian integers.

function bytesOf(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

export function integersOf(text) {
  const bytes = bytesOf(text);
  const view = new DataView(bytes.buffer);
  return Uint16Array.from({ length: bytes.length / 2 }, (_, index) => view.getUint16(2 * index, true));
}

/** x, y, z in turn. The camera's frame has y down and z forward; here y is up and z towards the reader. */
export function positionsOf(text, box) {
  const integers = integersOf(text);
  const turned = [1, -1, -1];
  return Float32Array.from(integers, (value, index) =>
    turned[index % 3] * (box.low[index % 3] + value * box.step));
}

/** mm; NaN where unknown. */
export function errorsOf(text, largest) {
  return Float32Array.from(bytesOf(text), (value) => (value === 255 ? NaN : (value / 254) ** 2 * largest));
}

/** Joins the points of a frame with their neighbours in the grid of pixels, but for those with air between them. */
function gridTriangles(step, { box, frames: { columns, gap } }) {
  const points = positionsOf(step.points, box);
  const cells = integersOf(step.cells);
  const pointAt = new Map([...cells].map((cell, index) => [cell, index]));
  const isNear = (a, b) => Math.hypot(...[0, 1, 2].map((axis) => points[3 * a + axis] - points[3 * b + axis])) <= gap;
  const triangles = [];
  const add = (a, b, c) => {
    if (a === undefined || b === undefined || c === undefined) return;
    if (isNear(a, b) && isNear(b, c) && isNear(c, a)) triangles.push(a, b, c);
  };
  cells.forEach((cell, here) => {
    if ((cell + 1) % columns === 0) return;
    const [right, below, across] = [cell + 1, cell + columns, cell + columns + 1].map((other) => pointAt.get(other));
    add(here, below, right);
    add(right, below, across);
  });
  return Uint16Array.from(triangles);
}

/** What is decoded of a step is kept: a reader goes back and forth. */
export function stepReader(data) {
  const known = new Map();
  const read = (step) => ({
    points: positionsOf(step.points, data.box),
    errors: {
      nearest: errorsOf(step.nearest, data.largest_error),
      truth: step.truth ? errorsOf(step.truth, data.largest_error) : null,
    },
    nodes: positionsOf(step.nodes, data.box),
    constraints: positionsOf(step.constraints, data.box),
    triangles: step.cells ? gridTriangles(step, data) : null,
    camera: positionsOf(step.camera ?? "", data.box),
  });
  return (index) => {
    if (!known.has(index)) known.set(index, read(data.steps[index]));
    return known.get(index);
  };
}

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
  });
  return (index) => {
    if (!known.has(index)) known.set(index, read(data.steps[index]));
    return known.get(index);
  };
}

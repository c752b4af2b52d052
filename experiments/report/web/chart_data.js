// A chart's points as uPlot takes them: one list of places, and one value a series at each.

/** `data` for uPlot, and `points[series][place]`, undefined where a series has none. */
function aligned(chart, places, placeOf) {
  const points = chart.series.map((series) => {
    const byPlace = new Map(series.points.map((point) => [placeOf(point), point]));
    return places.map((place) => byPlace.get(place));
  });
  const values = points.map((row) => row.map((point) => point?.value ?? null));
  return { data: [places, ...values], points };
}

/** Over the frames of a stream: without marks, and broken where a frame has no value. */
export function isDense(chart) {
  return chart.kind === "frames";
}

export function lineData(chart) {
  const isThere = (point) => point.x !== null && point.value !== null &&
    (!chart.x.is_log || point.x > 0) && (!chart.y.is_log || point.value > 0);
  const series = chart.series.map((one) => ({ ...one, points: one.points.filter(isThere) }));
  const placed = isDense(chart) ? chart.series : series;  // where it is broken there is a place, too
  const places = [...new Set(placed.flatMap((one) => one.points.map((point) => point.x)))].sort((a, b) => a - b);
  return aligned({ ...chart, series }, places, (point) => point.x);
}

export function barData(chart) {
  const places = chart.labels.map((_, index) => index);
  return aligned(chart, places, (point) => chart.labels.indexOf(point.label));
}

export function stacked(chart) {
  return chart.kind === "stacked_bars";
}

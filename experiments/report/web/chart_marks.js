// What is painted into a plot beside its lines: bars, marks and whiskers. All sizes are in pixels of the page.

/** Each series has a mark of its own, for who cannot tell the colours. */
const outlines = [
  (paint, x, y, r) => paint.arc(x, y, r, 0, 2 * Math.PI),
  (paint, x, y, r) => paint.rect(x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r),
  (paint, x, y, r) => polygon(paint, [[x, y - 1.3 * r], [x + 1.2 * r, y + 0.8 * r], [x - 1.2 * r, y + 0.8 * r]]),
  (paint, x, y, r) => polygon(paint, [[x, y - 1.3 * r], [x + 1.3 * r, y], [x, y + 1.3 * r], [x - 1.3 * r, y]]),
];

function polygon(paint, corners) {
  corners.forEach(([x, y], index) => (index === 0 ? paint.moveTo(x, y) : paint.lineTo(x, y)));
  paint.closePath();
}

function whisker(plot, point, x, half, color) {
  if (!(point.spread > 0)) return;
  const { ctx: paint } = plot;
  const bottom = plot.bbox.top + plot.bbox.height;
  const isLog = plot.scales.y.distr === 3;
  const low = isLog && point.value <= point.spread ? bottom : plot.valToPos(point.value - point.spread, "y", true);
  const high = plot.valToPos(point.value + point.spread, "y", true);
  paint.strokeStyle = color;
  paint.lineWidth = 1.4 * devicePixelRatio;
  paint.beginPath();
  for (const [x1, y1, x2, y2] of [[x, low, x, high], [x - half, low, x + half, low], [x - half, high, x + half, high]]) {
    paint.moveTo(x1, y1);
    paint.lineTo(x2, y2);
  }
  paint.stroke();
}

/** Dashed across the plot, each with its name above its end. */
export function limitPainter(limits, ink, font) {
  return (plot) => {
    const { ctx: paint, bbox } = plot;
    paint.save();
    paint.strokeStyle = paint.fillStyle = ink();
    paint.lineWidth = 1.3 * devicePixelRatio;
    paint.setLineDash([7 * devicePixelRatio, 5 * devicePixelRatio]);
    paint.font = font.replace("12px", `${12 * devicePixelRatio}px`);
    paint.textAlign = "right";
    paint.textBaseline = "bottom";
    for (const limit of limits) {
      const y = plot.valToPos(limit.value, "y", true);
      paint.beginPath();
      paint.moveTo(bbox.left, y);
      paint.lineTo(bbox.left + bbox.width, y);
      paint.stroke();
      paint.fillText(limit.text, bbox.left + bbox.width - 4 * devicePixelRatio, y - 3 * devicePixelRatio);
    }
    paint.restore();
  };
}

export function linePainter(points, color, paper) {
  return (plot) => {
    const { ctx: paint } = plot;
    points.forEach((row, series) => row.forEach((point) => {
      if (!point) return;
      const x = plot.valToPos(point.x, "x", true);
      whisker(plot, point, x, 4 * devicePixelRatio, color(series));
      paint.beginPath();
      outlines[series % 4](paint, x, plot.valToPos(point.value, "y", true), 4 * devicePixelRatio);
      paint.fillStyle = color(series);
      paint.fill();
      paint.strokeStyle = paper();
      paint.lineWidth = devicePixelRatio;
      paint.stroke();
    }));
  };
}

function bar(plot, x, width, from, to, color) {
  plot.ctx.fillStyle = color;
  plot.ctx.fillRect(x, Math.min(from, to), width, Math.max(Math.abs(to - from), 1));
}

function paintBeside(plot, points, color, ink) {
  const slot = plot.valToPos(1, "x", true) - plot.valToPos(0, "x", true);
  const width = Math.min((0.8 * slot) / points.length, 64 * devicePixelRatio);
  const isLog = plot.scales.y.distr === 3;
  const floor = isLog ? plot.bbox.top + plot.bbox.height : plot.valToPos(0, "y", true);
  points.forEach((row, series) => row.forEach((point, index) => {
    if (!point || point.value === null || (isLog && point.value <= 0)) return;
    const left = plot.valToPos(index, "x", true) + width * (series - points.length / 2);
    bar(plot, left + 0.05 * width, 0.9 * width, floor, plot.valToPos(point.value, "y", true), color(series));
    whisker(plot, point, left + width / 2, 5 * devicePixelRatio, ink());
  }));
}

function paintStacked(plot, points, color) {
  const slot = plot.valToPos(1, "x", true) - plot.valToPos(0, "x", true);
  const width = Math.min(0.7 * slot, 96 * devicePixelRatio);
  const reached = points[0].map(() => 0);
  points.forEach((row, series) => row.forEach((point, index) => {
    if (!point || point.value === null) return;
    const from = plot.valToPos(reached[index], "y", true);
    reached[index] += point.value;
    bar(plot, plot.valToPos(index, "x", true) - width / 2, width, from, plot.valToPos(reached[index], "y", true),
      color(series));
  }));
}

export function barPainter(points, isStacked, color, ink) {
  return (plot) => (isStacked ? paintStacked(plot, points, color) : paintBeside(plot, points, color, ink));
}

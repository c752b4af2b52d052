// Draws each chart of the page anew, so that its values can be read off.
import uPlot from "uplot";
import { barPainter, limitPainter, linePainter } from "./chart_marks.js";
import { barData, isDense, lineData, stacked } from "./chart_data.js";
import { dataOf, onOtherColors, variable, whenSeen } from "./page_data.js";

const font = "12px system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";
const height = 320;
const letter = 6.8;

const colorsOf = (chart) => (series) => variable(`--s${chart.series[series].color}`);
const longest = (labels) => Math.max(0, ...labels.map((label) => label.length)) * letter;

function axisStyle() {
  return {
    font,
    labelFont: font,
    stroke: () => variable("--quiet"),
    grid: { stroke: () => variable("--grid"), width: 1 },
    ticks: { show: false },
  };
}

function yAxis(axis) {
  return { ...axisStyle(), label: axis.label, splits: () => axis.ticks, values: () => axis.labels,
    filter: (_, splits) => splits, size: longest(axis.labels) + 16, labelSize: 20 };
}

/** Labels that would touch the one before are left away. */
function thinned(plot, axis) {
  let end = -Infinity;
  return axis.ticks.map((tick, index) => {
    const middle = plot.valToPos(tick, "x");
    const half = (axis.labels[index].length * letter) / 2;
    if (middle - half < end) return "";
    end = middle + half + 4;
    return axis.labels[index];
  });
}

function numberAxis(axis) {
  return { ...axisStyle(), label: axis.label, splits: () => axis.ticks, values: (plot) => thinned(plot, axis),
    filter: (_, splits) => splits, grid: { show: false }, size: 28, labelSize: 22 };
}

function wordAxis(axis, labels, width) {
  const tilts = longest(labels) > (width - 90) / labels.length - 6;
  return { ...axisStyle(), label: axis.label, splits: () => labels.map((_, index) => index),
    values: () => labels, rotate: tilts ? 30 : 0, grid: { show: false },
    size: tilts ? Math.min(longest(labels) * 0.5, 90) + 24 : 28, labelSize: 22 };
}

/** Every series tells its value that is nearest to the pointer. */
function nearestKnown(plot, series, hovered) {
  const values = plot.data[series];
  if (series === 0 || values[hovered] != null) return hovered;
  const known = [...values.keys()].filter((index) => values[index] != null);
  const distance = (index) => Math.abs(plot.valToPos(plot.data[0][index], "x") - plot.cursor.left);
  return known.length === 0 ? hovered
    : known.reduce((best, index) => (distance(index) < distance(best) ? index : best));
}

function lineSeries(chart, points) {
  const color = colorsOf(chart);
  return chart.series.map((series, index) => ({
    label: series.name,
    stroke: () => color(index),
    width: 2,
    spanGaps: !isDense(chart),
    points: { show: false },
    value: (plot, _, number, at) => {
      const point = at === null ? null : points[number - 1][at];
      return point ? `${point.text} at ${point.label}` : "–";
    },
  }));
}

function barSeries(chart, points) {
  const color = colorsOf(chart);
  return chart.series.map((series, index) => ({
    label: series.name,
    stroke: () => color(index),
    fill: () => color(index),
    paths: () => null,
    points: { show: false },
    value: (plot, _, number, at) => (at === null ? null : points[number - 1][at])?.text ?? "–",
  }));
}

function commonOptions(chart, width) {
  return {
    width,
    height,
    padding: [12, 12, 0, 0],
    cursor: { drag: { x: false, y: false }, y: false, dataIdx: nearestKnown,
      points: { size: 9, width: 2 } },
    scales: { y: { distr: chart.y.is_log ? 3 : 1, range: () => [chart.y.low, chart.y.high] } },
  };
}

function lineChart(chart, width) {
  const { data, points } = lineData(chart);
  const options = commonOptions(chart, width);
  options.scales.x = { time: false, distr: chart.x.is_log ? 3 : 1, range: () => [chart.x.low, chart.x.high] };
  options.axes = [numberAxis(chart.x), yAxis(chart.y)];
  options.series = [{ label: chart.x.label, value: () => "" }, ...lineSeries(chart, points)];
  const marks = isDense(chart) ? [] : [linePainter(points, colorsOf(chart), () => variable("--card"))];
  options.hooks = { draw: [...marks, limitPainter(chart.limits, () => variable("--ink"), font)] };
  return { options, data };
}

function barChart(chart, width) {
  const { data, points } = barData(chart);
  const options = commonOptions(chart, width);
  options.scales.x = { time: false, range: () => [-0.5, chart.labels.length - 0.5] };
  options.axes = [wordAxis(chart.x, chart.labels, width), yAxis(chart.y)];
  options.series = [{ label: chart.x.label, value: (_, at) => (at === null ? "" : chart.labels[at]) },
    ...barSeries(chart, points)];
  options.hooks = { draw: [barPainter(points, stacked(chart), colorsOf(chart), () => variable("--ink")),
    limitPainter(chart.limits, () => variable("--ink"), font)] };
  options.cursor.points = { show: false };
  return { options, data };
}

function show(figure) {
  const chart = dataOf(figure);
  const picture = figure.querySelector(".chart-static");
  const place = document.createElement("div");
  place.className = "live chart-live";
  picture.after(place);
  picture.hidden = true;
  const make = chart.kind === "lines" || isDense(chart) ? lineChart : barChart;
  let plot;
  const draw = () => {
    plot?.destroy();
    const { options, data } = make(chart, place.clientWidth);
    plot = new uPlot(options, data, place);
  };
  draw();
  onOtherColors(draw);
  new ResizeObserver(() => plot.width !== place.clientWidth && place.clientWidth > 0 && draw()).observe(place);
}

export function showCharts() {
  for (const figure of document.querySelectorAll(".chart-figure"))
    if (figure.querySelector("svg")) whenSeen(figure, () => show(figure));
}

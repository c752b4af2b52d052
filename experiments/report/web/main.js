// What makes the figures of a page move. The page itself needs none of it.
import "uplot/dist/uPlot.min.css";
import { showCharts } from "./charts.js";
import { showViews } from "./views.js";

showCharts();
showViews();

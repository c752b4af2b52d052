// Shows the runs of the page in three dimensions, each when it comes into sight.
import { dataOf, onOtherColors, whenSeen } from "./page_data.js";
import { makeStage } from "./stage.js";
import { Viewer } from "./viewer.js";

function sayThatThereIsNone(figure) {
  const notice = document.createElement("p");
  notice.className = "notice";
  notice.textContent = "This browser has no WebGL to draw three dimensions with; a picture stands in.";
  figure.prepend(notice);
}

export function showViews() {
  const figures = [...document.querySelectorAll(".view-figure")];
  if (figures.length === 0) return;
  const scales = figures.map((figure) => Number(figure.dataset.scale)).sort((a, b) => a - b);
  const viewers = [];
  // One scale for all, so that a colour means the same everywhere on the page: that of the one in the middle, or a
  // single bad run would make all others alike.
  const setScale = (value) => viewers.forEach((viewer) => viewer.setScale(value));
  const scale = { value: scales[Math.floor(scales.length / 2)], set: (value) => { scale.value = value; setScale(value); } };
  let stage;
  const show = (figure) => {
    stage ??= makeStage();
    if (stage) viewers.push(new Viewer(figure, dataOf(figure), stage, scale));
    else sayThatThereIsNone(figure);
  };
  for (const figure of figures) whenSeen(figure, () => show(figure));
  onOtherColors(() => viewers.forEach((viewer) => viewer.draw()));
}

// A view of one run: its canvas, and what turns it, plays it and switches its layers.
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { element, checkbox, choice, slider, numberField } from "./view_controls.js";
import { errorGradient } from "./error_colors.js";
import { ViewScene } from "./view_scene.js";

// What a view shows: the iterations of a registration, or frames that were tracked.
const iterations = {
  step: "iteration", shown: ["registered"],
  layers: { registered: "registered, by error", source: "source", target: "target", graph: "deformation graph",
    quadtree: "quadtree", constraints: "constraints", unmatched: "unmatched points" },
  errors: { nearest: "to the nearest target point", truth: "to the true position" },
};
const frames = {
  step: "frame", shown: ["registered", "path", "camera"],
  layers: { registered: "frame, by distance", target: "model", path: "path of the camera", camera: "camera" },
  errors: { nearest: "to the model" },
};
const besideTheCamera = [0.45, 0.3, 1], besideItsPath = [1, 0.45, 0.35];
const secondsAStep = 0.6;

export class Viewer {
  constructor(figure, data, stage, scale) {
    this.data = data;
    this.words = data.frames ? frames : iterations;
    this.stage = stage;
    this.scale = scale;
    this.scene = new ViewScene(data);
    this.step = data.result;
    this.kind = "nearest";
    this.build(figure);
    this.resize();
    this.aim();
    this.setScale(scale.value);
  }

  build(figure) {
    this.canvas = element("canvas");
    this.canvas.setAttribute("aria-label", "The run in three dimensions");
    this.legend = element("div", "view-scale");
    const hint = element("div", "view-hint", "drag to turn, with the right button to move; click, then scroll to come nearer");
    const box = element("div", "view-box", this.canvas, this.legend, hint);
    this.status = element("p", "view-status");
    const place = element("div", "live view-live", box, this.makeTimeline(), this.status, this.makeSwitches());
    const picture = figure.querySelector(".view-static");
    picture.after(place);
    picture.hidden = true;
    this.camera = new PerspectiveCamera(35, 1, 1, 1e5);
    this.orbit = new OrbitControls(this.camera, this.canvas);
    this.orbit.addEventListener("change", () => this.draw());
    // Who scrolls through the page shall not be caught by a view.
    this.orbit.enableZoom = false;
    this.canvas.addEventListener("pointerdown", () => { this.orbit.enableZoom = true; });
    this.canvas.addEventListener("pointerleave", () => { this.orbit.enableZoom = false; });
    new ResizeObserver(() => this.resize()).observe(box);
  }

  makeTimeline() {
    this.timeline = slider(this.words.step, this.data.steps.length - 1, this.step, (step) => this.goTo(step));
    this.playButton = element("button", "play", "play");
    this.playButton.type = "button";
    this.playButton.addEventListener("click", () => this.play());
    return element("div", "view-timeline", this.playButton, this.timeline);
  }

  makeSwitches() {
    const { layers, shown, errors } = this.words;
    const boxes = Object.entries(layers).filter(([layer]) => this.scene.has(layer)).map(([layer, name]) => {
      this.scene.show(layer, shown.includes(layer));
      return checkbox(name, layer, shown.includes(layer), (on) => { this.scene.show(layer, on); this.draw(); });
    });
    for (const layer of Object.keys(this.scene.layers)) if (!this.scene.has(layer)) this.scene.show(layer, false);
    const kinds = Object.entries(errors).filter(([kind]) => kind === "nearest" || this.data.has_truth);
    const reset = element("button", "reset", "reset the view");
    reset.type = "button";
    reset.addEventListener("click", () => this.aim());
    this.highest = numberField("colours end at", "mm", this.scale.value, (value) => this.scale.set(value));
    return element("div", "view-switches", element("div", "view-layers", ...boxes),
      element("div", "view-errors", choice("distance", kinds, (kind) => { this.kind = kind; this.refresh(); }),
        this.highest, reset));
  }

  /** Looks from beside the camera that took the depth, or from beside its path where that is seen, too. */
  aim() {
    const { centre, radius, framesPath } = this.scene;
    const fit = (1.02 * radius) / Math.sin((17.5 * Math.PI) / 180) / Math.min(this.camera.aspect, 1);
    const back = new Vector3(...(framesPath ? besideItsPath : besideTheCamera)).normalize().multiplyScalar(fit);
    this.camera.position.copy(centre).add(back);
    this.camera.near = radius / 50;
    this.camera.far = radius * 50;
    this.orbit.target.copy(centre);
    this.orbit.update();
    this.draw();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0) return;
    this.canvas.width = Math.round(clientWidth * devicePixelRatio);
    this.canvas.height = Math.round(clientHeight * devicePixelRatio);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.paint();
  }

  setScale(highest) {
    this.highest.querySelector("input").value = highest;
    const label = (part) => element("span", "", String(+(part * highest).toPrecision(3)));
    this.legend.replaceChildren(element("span", "unit", "mm"), element("div", "ramp"),
      element("div", "ticks", label(1), label(0.75), label(0.5), label(0.25), label(0)));
    this.legend.querySelector(".ramp").style.background = errorGradient();
    this.legend.querySelector(".ticks").firstChild.prepend("≥ ");
    this.refresh();
  }

  goTo(step) {
    this.step = step;
    this.refresh();
  }

  refresh() {
    this.scene.setStep(this.step, this.kind, this.scale.value);
    this.timeline.querySelector("input").value = this.step;
    this.status.textContent = this.describe();
    this.draw();
  }

  describe() {
    const step = this.data.steps[this.step];
    const errors = this.scene.stepAt(this.step).errors[this.kind].filter((error) => !Number.isNaN(error));
    const mean = errors.reduce((sum, error) => sum + error, 0) / Math.max(errors.length, 1);
    return [...this.nameOf(step), `mean distance ${mean.toFixed(2)} mm`, ...this.countsOf(step)].join(" · ");
  }

  nameOf(step) {
    if (this.data.frames) return [`frame ${step.number}`, step.state];
    const name = step.number === 0 ? "after the initial alignment" : `iteration ${step.number}`;
    return [this.step === this.data.result ? `${name} (the result)` : name];
  }

  countsOf(step) {
    const { nodes, constraints, points } = this.scene.stepAt(this.step);
    if (this.data.frames) return [`${points.length / 3} points drawn`];
    const counts = [`${nodes.length / 3} nodes`];
    const shown = constraints.length / 6;
    if (step.number > 0) counts.push(`${step.constraint_count} matched constraints` +
      (shown < step.constraint_count ? `, ${shown} of them drawn` : ""));
    return counts;
  }

  /** From the first step to the last; once more pressed, it stops. */
  play() {
    if (this.playing) return this.stop();
    let step = 0;
    const next = () => {
      this.goTo(step++);
      if (step >= this.data.steps.length) this.stop();
    };
    this.playButton.textContent = "stop";
    this.playing = setInterval(next, 1000 * secondsAStep);
    next();
  }

  stop() {
    clearInterval(this.playing);
    this.playing = null;
    this.playButton.textContent = "play";
  }

  /** However much changes, there is one picture a frame. */
  draw() {
    this.due ??= requestAnimationFrame(() => this.paint());
  }

  paint() {
    cancelAnimationFrame(this.due);
    this.due = null;
    if (this.canvas.width > 0) this.stage.draw(this.scene.scene, this.camera, this.canvas);
  }
}

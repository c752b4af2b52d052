// A registration as a scene: each layer can be shown or not, and what moves follows the steps.
import {
  AmbientLight, BufferAttribute, BufferGeometry, CanvasTexture, Color, DirectionalLight, DoubleSide, Group,
  Line, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial, Points, PointsMaterial, Scene, SRGBColorSpace,
  Vector3,
} from "three";
import { errorColor } from "./error_colors.js";
import { integersOf, positionsOf, stepReader } from "./view_data.js";

// Of a camera: from where it is to the corners of its picture, and around that.
const cameraLines = Uint16Array.from([0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1]);
const levelColors = ["#1f77b4", "#ff7f0e", "#2c8c3c", "#c846bd", "#d62728", "#009696"];

function surface(points, triangles, color) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  geometry.computeVertexNormals();
  // Lines that lie on the surface are seen.
  return new Mesh(geometry, new MeshLambertMaterial({ color, side: DoubleSide, polygonOffset: true,
    polygonOffsetFactor: 1, polygonOffsetUnits: 2 }));
}

function lines(color) {
  return new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color }));
}

/** From point to point. */
function path(positions, color) {
  const line = new Line(new BufferGeometry(), new LineBasicMaterial({ color }));
  place(line, positions);
  return line;
}

/** A round dot. */
function dot() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const paint = canvas.getContext("2d");
  paint.arc(16, 16, 15, 0, 2 * Math.PI);
  paint.fillStyle = "white";
  paint.fill();
  return new CanvasTexture(canvas);
}

function dots(color, size) {
  return new Points(new BufferGeometry(), new PointsMaterial({ color, size: size * devicePixelRatio,
    sizeAttenuation: false, map: dot(), alphaTest: 0.5 }));
}

/** Gives an object other points; `indices` say which of them it joins. */
function place(object, positions, indices = null) {
  object.geometry.dispose();
  object.geometry = new BufferGeometry();
  object.geometry.setAttribute("position", new BufferAttribute(positions, 3));
  if (indices) object.geometry.setIndex(new BufferAttribute(indices, 1));
}

export class ViewScene {
  constructor(data) {
    this.data = data;
    this.stepAt = stepReader(data);
    this.graphs = data.graphs.map((graph) => ({ edges: integersOf(graph.edges),
      cells: graph.cells.map((cell) => ({ level: cell.level, lines: integersOf(cell.lines) })) }));
    this.unmatched = integersOf(data.unmatched);
    this.scene = new Scene();
    this.addLights();
    this.layers = this.makeLayers();
    Object.values(this.layers).forEach((layer) => this.scene.add(layer));
    this.frame();
  }

  addLights() {
    this.scene.add(new AmbientLight("white", 1.05));
    // From beside the camera that took the depth, which is in the origin.
    const light = new DirectionalLight("white", 2.4);
    light.position.set(0.5, 0.7, 1);
    this.scene.add(light);
  }

  makeLayers() {
    const { data } = this;
    const triangles = integersOf(data.source.triangles);
    const registered = surface(positionsOf(data.source.points, data.box), triangles, "white");
    registered.material.vertexColors = true;
    const graph = new Group();
    this.edges = lines("#3b4450");
    this.nodes = dots("#101418", 7);
    graph.add(this.edges, this.nodes);
    this.constraints = lines("#d4267d");
    this.hidden = dots("#d4267d", 4);
    this.path = positionsOf(data.frames?.path ?? "", data.box);
    this.camera = lines("#d4267d");
    return {
      source: surface(positionsOf(data.source.points, data.box), triangles, "#8fa3bf"),
      target: surface(positionsOf(data.target.points, data.box), integersOf(data.target.triangles), "#c9c6bd"),
      registered,
      graph,
      quadtree: new Group(),
      constraints: this.constraints,
      unmatched: this.hidden,
      path: path(this.path, "#1f77b4"),
      camera: this.camera,
    };
  }

  /** Whether there is anything to show of a layer. */
  has(layer) {
    if (layer === "quadtree") return this.graphs.some((graph) => graph.cells.length > 0);
    if (layer === "unmatched") return this.unmatched.length > 0;
    if (layer === "source") return this.data.source.points.length > 0;
    if (layer === "path" || layer === "camera") return this.path.length > 0;
    if (layer === "graph") return this.graphs.length > 0;
    return layer !== "constraints" || this.data.steps.some((step) => step.constraint_count > 0);
  }

  show(layer, is_shown) {
    this.layers[layer].visible = is_shown;
  }

  /** Moves everything to a step, and colours it by `kind` of error, whose scale ends at `highest` mm. */
  setStep(index, kind, highest) {
    const step = this.stepAt(index);
    const graph = this.graphs[this.data.steps[index].graph];
    this.move(this.layers.registered, step.points, step.triangles);
    this.color(step.errors[kind], highest);
    place(this.nodes, step.nodes);
    place(this.edges, step.nodes, graph?.edges ?? null);
    place(this.constraints, step.constraints);
    place(this.hidden, this.pick(step.points, this.unmatched));
    place(this.camera, step.camera, cameraLines);
    this.drawCells(step.points, graph?.cells ?? []);
  }

  /** `triangles`: where a step has other ones. */
  move(mesh, positions, triangles) {
    if (triangles) place(mesh, positions, triangles);
    else mesh.geometry.setAttribute("position", new BufferAttribute(positions, 3));
    mesh.geometry.computeVertexNormals();
    mesh.geometry.boundingSphere = null;
  }

  color(errors, highest) {
    const colors = new Float32Array(3 * errors.length);
    const color = new Color();
    errors.forEach((error, index) => {
      color.setRGB(...errorColor(error / highest), SRGBColorSpace).toArray(colors, 3 * index);
    });
    this.layers.registered.geometry.setAttribute("color", new BufferAttribute(colors, 3));
  }

  pick(positions, indices) {
    const picked = new Float32Array(3 * indices.length);
    indices.forEach((index, at) => picked.set(positions.subarray(3 * index, 3 * index + 3), 3 * at));
    return picked;
  }

  drawCells(positions, cells) {
    const group = this.layers.quadtree;
    group.children.forEach((child) => { child.geometry.dispose(); child.material.dispose(); });
    group.clear();
    for (const [index, color] of levelColors.entries()) {
      const drawn = cells.filter((cell) => (cell.level - 1) % levelColors.length === index);
      if (drawn.length === 0) continue;
      const rims = lines(color);
      place(rims, positions, Uint16Array.from(drawn.flatMap((cell) => [...cell.lines])));
      group.add(rims);
    }
  }

  /** The middle of the result, and how far it reaches from there; both with where the camera went, unless the result
   * would be small beside that. */
  frame() {
    const result = this.endsOfResult();
    const whole = result.map(([low, high], axis) => {
      const places = this.path.filter((_, index) => index % 3 === axis);
      return [Math.min(low, ...places), Math.max(high, ...places)];
    });
    const radius = (ends) => Math.max(Math.hypot(...ends.map(([low, high]) => (high - low) / 2)), 1);
    this.framesPath = this.path.length > 0 && radius(whole) <= 2 * radius(result);
    const ends = this.framesPath ? whole : result;
    this.centre = new Vector3(...ends.map(([low, high]) => (low + high) / 2));
    this.radius = radius(ends);
  }

  /** Along each axis, whatever strays left out. */
  endsOfResult() {
    const { points } = this.stepAt(this.data.result);
    return [0, 1, 2].map((axis) => {
      const sorted = points.filter((_, index) => index % 3 === axis).sort();
      return [0.02, 0.98].map((share) => sorted[Math.floor(share * (sorted.length - 1))] ?? 0);
    });
  }
}

// One WebGL context for all views of a page: browsers take away the contexts of a page that has many.
import { WebGLRenderer } from "three";

function hasWebGL() {
  return Boolean(document.createElement("canvas").getContext("webgl2"));
}

/** Something that draws scenes into the 2D canvases of the page; null where there is no WebGL. */
export function makeStage() {
  if (!hasWebGL()) return null;
  const renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setClearAlpha(0);
  return {
    draw(scene, camera, canvas) {
      renderer.setSize(canvas.width, canvas.height, false);
      renderer.render(scene, camera);
      const paint = canvas.getContext("2d");
      paint.clearRect(0, 0, canvas.width, canvas.height);
      paint.drawImage(renderer.domElement, 0, 0);
    },
  };
}

// run_page_test.mjs PLIANT FOLDER: the page of a run that the program makes into FOLDER.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { assertQuiet, changes, checkLayout, colorsOf, eventually, openBrowser, openPage, pixelsOf } from "./browser.mjs";

const [pliant, folder] = process.argv.slice(2);
const file = `${folder}/result/index.html`;
const experiment = `
extends: methods/ad_nodes_ad_cons.yaml
alignment: none
data: {type: synthetic_sheet, image_width: 160, image_height: 120, focal_length: 131.25, noise: 1}
correspondence: {type: projective, rim: 6}
`;

let browser;
let page;
let canvas;
before(async () => {
  writeFileSync(`${folder}/small.yaml`, experiment);
  execFileSync(pliant, ["run", `${folder}/small.yaml`, "--out", `${folder}/result`]);
  browser = await openBrowser();
  page = await openPage(browser, file);
  canvas = page.locator(".view-live canvas");
});
after(() => browser?.close());

test("nothing is cut off, on any screen", () => checkLayout(page, "run"));

test("plots and the view are drawn", async () => {
  for (const plot of await page.$$(".chart-live canvas")) assert.ok(await colorsOf(plot) > 8);
  assert.ok(await colorsOf(canvas) > 100);
});

test("each layer can be switched", async () => {
  const boxes = page.locator(".view-layers input");
  assert.deepEqual(await boxes.evaluateAll((all) => all.map((box) => box.value)),
    ["registered", "source", "target", "graph", "quadtree", "constraints", "unmatched"]);
  for (const box of await boxes.all()) await changes(canvas, () => box.click(), await box.inputValue());
  for (const box of await boxes.all()) await changes(canvas, () => box.click(), await box.inputValue());
});

test("the slider goes through the iterations, and play does", async () => {
  await changes(canvas, () => page.locator(".view-timeline input").fill("0"), "the iteration");
  const status = page.locator(".view-status");
  assert.match(await status.innerText(), /after the initial alignment · mean distance \d+\.\d\d mm/);
  await page.locator("button.play").click();
  await eventually(async () => /iteration [1-9]/.test(await status.innerText()), "no other iteration was played");
  await eventually(async () => await page.locator("button.play").innerText() === "play", "it plays on");
});

test("errors can be those to the truth, on another scale", async () => {
  await changes(canvas, () => page.locator(".view-errors select").selectOption("truth"), "the kind of error");
  const highest = page.locator(".view-errors input");
  await changes(canvas, async () => {
    await highest.fill("50");
    await highest.press("Enter");
  }, "the scale");
  assert.match(await page.locator(".view-scale").innerText(), /≥ 50/);
});

test("the view turns, and is reset", async () => {
  const first = await pixelsOf(canvas);
  const box = await canvas.boundingBox();
  await changes(canvas, async () => {
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 + 30, { steps: 4 });
    await page.mouse.up();
  }, "turned by the mouse");
  await page.locator("button.reset").click();
  await eventually(async () => await pixelsOf(canvas) === first, "reset leads elsewhere");
});

test("no error, and nothing asked for beyond the file", () => assertQuiet(page));

test("without WebGL a picture stands in, and the page says so", async () => {
  const flat = await openBrowser(["--disable-3d-apis"]);
  try {
    const other = await openPage(flat, file);
    await other.locator(".view-figure").scrollIntoViewIfNeeded();
    await other.locator(".view-figure .notice", { hasText: "no WebGL" }).waitFor();
    assert.ok(await other.locator(".view-static img").isVisible());
    assert.equal(await other.locator(".view-live").count(), 0);
  } finally {
    await flat.close();
  }
});

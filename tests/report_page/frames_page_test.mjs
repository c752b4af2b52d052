// frames_page_test.mjs FOLDER: the page that make_pages wrote there of frames that were tracked.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assertQuiet, changes, checkLayout, colorsOf, coverageOf, eventually, openBrowser, openPage } from "./browser.mjs";

const folder = process.argv[2];
let browser;
let page;
let canvas;
before(async () => {
  browser = await openBrowser();
  page = await openPage(browser, `${folder}/frames.html`);
  canvas = page.locator(".view-live canvas");
});
after(() => browser?.close());

test("nothing is cut off, on any screen", () => checkLayout(page, "frames"));

test("the surface is seen large, however far the camera that took it was", async () => {
  assert.ok(await colorsOf(canvas) > 40);
  assert.ok(await coverageOf(canvas) > 0.1);
});

test("frame, path and camera are drawn, and each layer can be switched", async () => {
  await canvas.click(); // from then on the wheel is the view's
  await changes(canvas, () => page.mouse.wheel(0, 3500), "further away, where the path is seen, too");
  const boxes = page.locator(".view-layers input");
  const values = (all) => all.filter((box) => box.checked).map((box) => box.value);
  assert.deepEqual(await boxes.evaluateAll(values), ["registered", "path", "camera"]);
  assert.equal(await boxes.count(), 4);
  for (const box of await boxes.all()) await changes(canvas, () => box.click(), await box.inputValue());
  // Back in the other order: the model may hide the frame.
  for (const box of (await boxes.all()).reverse()) await changes(canvas, () => box.click(), await box.inputValue());
});

test("the chart over frames is drawn, and tells the value of a frame", async () => {
  const plot = page.locator(".chart-live");
  await plot.scrollIntoViewIfNeeded();
  assert.ok(await colorsOf(plot.locator("canvas")) > 8);
  const box = await plot.locator(".u-over").boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  const legend = await plot.locator(".u-legend").innerText();
  assert.match(legend, /rigid \+ non-rigid[^]*1\.9\d+ at (29|3\d)/);
  assert.match(legend, /rigid[^]*at (28|34)/, "the nearest frame that was not lost");
});

test("pictures of runs stand side by side, and are seen", async () => {
  const pictures = page.locator(".picture img");
  assert.equal(await pictures.count(), 2);
  for (const picture of await pictures.all())
    assert.ok(await picture.evaluate((image) => image.complete && image.naturalWidth > 0));
  const [left, right] = [await pictures.nth(0).boundingBox(), await pictures.nth(1).boundingBox()];
  assert.ok(right.x > left.x && Math.abs(right.y - left.y) < 2);
});

test("the slider goes through the frames, and play does", async () => {
  assert.match(await page.locator(".view-timeline label").innerText(), /^frame/);
  const status = page.locator(".view-status");
  assert.match(await status.innerText(), /^frame 5 · tracked · mean distance 5\.\d\d mm · 1200 points drawn$/);
  await changes(canvas, () => page.locator(".view-timeline input").fill("0"), "the frame");
  assert.match(await status.innerText(), /^frame 1 · tracked · mean distance 1\.\d\d mm/);
  await page.locator("button.play").click();
  await eventually(async () => /frame 3/.test(await status.innerText()), "no other frame was played");
  await page.locator("button.play").click();
});

test("the camera moves from frame to frame", async () => {
  await page.locator('.view-layers input[value="registered"]').uncheck();
  await page.locator('.view-layers input[value="path"]').uncheck();
  await changes(canvas, () => page.locator(".view-timeline input").fill("0"), "the camera");
  await changes(canvas, () => page.locator(".view-timeline input").fill("4"), "the camera");
});

test("no error, and nothing asked for beyond the file", () => assertQuiet(page));

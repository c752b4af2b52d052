// study_page_test.mjs FOLDER: the page of studies that make_pages wrote there.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assertQuiet, changes, checkLayout, colorsOf, openBrowser, openPage, seeAll } from "./browser.mjs";

const folder = process.argv[2];
let browser;
let page;
before(async () => {
  browser = await openBrowser();
  page = await openPage(browser, `${folder}/study.html`);
});
after(() => browser?.close());

const table = () => page.locator(".table", { hasText: "Table 5.1" });

async function copied(format) {
  const button = table().locator("button").nth(format);
  await button.click();
  await table().locator("button.done").nth(0).waitFor();
  return page.evaluate(() => navigator.clipboard.readText());
}

test("nothing is cut off, on any screen", () => checkLayout(page, "study"));

test("every plot is drawn, and tells its values", async () => {
  const plots = await page.$$(".chart-live canvas");
  assert.equal(plots.length, (await page.$$(".chart-figure")).length);
  for (const plot of plots) assert.ok(await colorsOf(plot) > 8);
  const first = page.locator(".chart-live").first();
  await first.scrollIntoViewIfNeeded();
  const box = await first.locator(".u-over").boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  assert.match(await first.locator(".u-legend").innerText(), /2\.35 ± 0\.19 \(10 runs\) at 32/);
  assert.equal(await page.locator(".chart-static:visible").count(), 0);
});

test("plots take other colours with the reader", async () => {
  const canvas = page.locator(".chart-live canvas").first();
  await changes(canvas, () => page.emulateMedia({ colorScheme: "dark" }), "to dark");
  await changes(canvas, () => page.emulateMedia({ colorScheme: "light" }), "to light");
});

test("tables are copied as CSV, LaTeX and Markdown", async () => {
  assert.match(await copied(0), /^data set,method,[^\n]*"EPE, 95th percentile"[^\n]*\nsheet,ED,256,/);
  const latex = await copied(1);
  assert.match(latex, /^\\begin\{tabular\}\{lr{10}\}\n\\toprule\ndata set & method & nodes/);
  assert.match(latex, /1\.25 \$\\pm\$ 0\.11/);
  assert.match(await copied(2), /^\| data set \| method \|.*\n\| --- \| --: \|.*\n\| sheet \| ED \| 256 \|/);
});

test("tables are copied where a page has no clipboard", async () => {
  await page.evaluate(() => {
    navigator.clipboard.writeText = () => Promise.reject(new Error("not from disk"));
  });
  await page.evaluate(() => navigator.clipboard.readText());
  assert.match(await copied(0), /^data set,method/);
});

test("print shows the pictures in place of what moves", async () => {
  await page.emulateMedia({ media: "print" });
  assert.equal(await page.locator(".live:visible").count(), 0);
  for (const kind of [".chart-static", ".view-static"])
    assert.equal(await page.locator(`${kind}:visible`).count(), await page.locator(kind).count());
  await page.emulateMedia({ media: "screen" });
});

test("findings lead to their places", async () => {
  await page.locator(".claims a").nth(1).click();
  assert.ok(await page.locator(".finding:target").isVisible());
});

test("a colour means the same in all views of a page", async () => {
  const second = page.locator(".view-live canvas").nth(1);
  const highest = page.locator(".view-live input[type=number]");
  await changes(second, async () => {
    await highest.first().fill("2");
    await highest.first().press("Enter");
  }, "the scale of the first view");
  assert.equal(await highest.nth(1).inputValue(), "2");
});

test("no error, and nothing asked for beyond the file", () => assertQuiet(page));

test("ten views on a page are all drawn", async () => {
  const views = await openPage(browser, `${folder}/ten_views.html`);
  console.log(`loaded after ${await views.evaluate(() => Math.round(performance.now()))} ms`);
  await seeAll(views);
  const canvases = await views.$$(".view-live canvas");
  assert.equal(canvases.length, 10);
  for (const canvas of canvases) assert.ok(await colorsOf(canvas) > 50);
  assertQuiet(views);
});

// study_page_test.mjs FOLDER: the page of studies that make_pages wrote there.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assertQuiet, colorsOf, cutOff, keepPicture, openBrowser, openPage, screens, seeAll } from "./browser.mjs";

const file = `${process.argv[2]}/study.html`;
let browser;
before(async () => { browser = await openBrowser(); });
after(() => browser?.close());

for (const [screen, width] of Object.entries(screens))
  for (const colors of ["light", "dark"])
    test(`nothing is cut off on a ${screen}, ${colors}`, async () => {
      const page = await openPage(browser, file, { width, colors });
      await seeAll(page);
      for (const fold of await page.$$("details")) await fold.evaluate((element) => { element.open = true; });
      assert.deepEqual(await cutOff(page), []);
      await keepPicture(page, `study-${screen}-${colors}`);
      assertQuiet(page);
    });

test("every plot is drawn, and tells its values", async () => {
  const page = await openPage(browser, file);
  await seeAll(page);
  const plots = await page.$$(".chart-live canvas");
  assert.equal(plots.length, (await page.$$(".chart-figure")).length);
  for (const plot of plots) assert.ok(await colorsOf(plot) > 8);
  const first = page.locator(".chart-live").first();
  await first.scrollIntoViewIfNeeded();
  const box = await first.locator(".u-over").boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  assert.match(await first.locator(".u-legend").innerText(), /2\.35 ± 0\.19 \(10 runs\) at 32/);
  assert.equal(await page.locator(".chart-static:visible").count(), 0);
  assertQuiet(page);
});

test("plots take other colours with the reader", async () => {
  const page = await openPage(browser, file);
  await seeAll(page);
  const pixels = () => page.$eval(".chart-live canvas", (canvas) => canvas.toDataURL());
  const light = await pixels();
  await page.emulateMedia({ colorScheme: "dark" });
  await page.waitForTimeout(200);
  assert.notEqual(await pixels(), light);
});

test("tables are copied as CSV, LaTeX and Markdown", async () => {
  const page = await openPage(browser, file);
  const table = page.locator(".table", { hasText: "Table 5.1" });
  const copied = async (name) => {
    await table.locator("button", { hasText: name }).click();
    await table.locator("button.done").waitFor();
    const text = await page.evaluate(() => navigator.clipboard.readText());
    await page.waitForTimeout(1300);
    return text;
  };
  assert.match(await copied("CSV"), /^data set,method,nodes,.*\n.*"EPE, 95th|^data set,method[^\n]*"EPE, 95th percentile"[^\n]*\nsheet,ED,256,/);
  const latex = await copied("LaTeX");
  assert.match(latex, /^\\begin\{tabular\}\{lr{10}\}\n\\toprule\ndata set & method & nodes/);
  assert.match(latex, /1\.25 \$\\pm\$ 0\.11/);
  assert.match(await copied("Markdown"), /^\| data set \| method \|.*\n\| --- \| --: \|.*\n\| sheet \| ED \| 256 \|/);
});

test("tables are copied where a page has no clipboard", async () => {
  const page = await openPage(browser, file);
  await page.evaluate(() => { navigator.clipboard.writeText = () => Promise.reject(new Error("no")); });
  const table = page.locator(".table", { hasText: "Table 5.1" });
  await table.locator("button", { hasText: "CSV" }).click();
  await table.locator("button.done").waitFor();
  assert.match(await page.evaluate(() => navigator.clipboard.readText()), /^data set,method/);
});

test("print shows the pictures in place of the plots", async () => {
  const page = await openPage(browser, file);
  await seeAll(page);
  await page.emulateMedia({ media: "print" });
  assert.equal(await page.locator(".chart-live:visible").count(), 0);
  assert.equal(await page.locator(".chart-static:visible").count(), await page.locator(".chart-static").count());
});

test("findings lead to their places", async () => {
  const page = await openPage(browser, file);
  await page.locator(".claims a").nth(1).click();
  assert.ok(await page.locator(".finding:target").isVisible());
});

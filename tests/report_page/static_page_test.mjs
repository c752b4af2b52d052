// static_page_test.mjs FOLDER: the page that comes where npm could not be reached, and one without any script.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assertQuiet, cutOff, keepPicture, openBrowser, openPage, screens } from "./browser.mjs";

const folder = process.argv[2];
let browser;
before(async () => { browser = await openBrowser(); });
after(() => browser?.close());

async function assertPictures(page) {
  for (const kind of [".chart-static svg", ".view-static img"])
    assert.equal(await page.locator(`${kind}:visible`).count(), await page.locator(kind).count());
  assert.ok(await page.locator(".chart-static svg").count() > 0);
  assert.ok(await page.locator(".view-static img").count() > 0);
}

test("without the bundle there are pictures, and the page says so", async () => {
  const page = await openPage(browser, `${folder}/static.html`);
  for (const [screen, width] of Object.entries(screens)) {
    await page.setViewportSize({ width, height: 900 });
    await assertPictures(page);
    assert.deepEqual(await cutOff(page), []);
    await keepPicture(page, `static-${screen}`);
  }
  assert.match(await page.locator(".notice").innerText(), /npm could not be reached/);
  assert.equal(await page.locator("canvas").count(), 0);
  await page.locator(".table", { hasText: "Table 5.1" }).locator("button", { hasText: "CSV" }).click();
  await page.locator("button.done").waitFor();
  assert.match(await page.evaluate(() => navigator.clipboard.readText()), /^data set,method/);
  assertQuiet(page);
});

test("without scripts there are pictures and tables", async () => {
  const page = await openPage(browser, `${folder}/study.html`, { javaScript: false });
  await assertPictures(page);
  assert.ok(await page.locator("table:visible tr").count() > 10);
});

test("a chart is a picture of its own", async () => {
  for (const colors of ["light", "dark"]) {
    const page = await openPage(browser, `${folder}/chart.html`, { colors, width: 720 });
    assert.ok(await page.$eval("img", (image) => image.complete && image.naturalWidth > 0));
    await keepPicture(page, `chart-file-${colors}`);
  }
});

// A browser without a window, and what is asked of every page.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { mkdirSync } from "node:fs";
import { pathToFileURL } from "node:url";

// Installed in the build folder, which is the current one.
const { chromium } = createRequire(`${process.cwd()}/`)("playwright-core");

export const screens = { phone: 390, laptop: 1280, desktop: 1920 };
const pictures = `${process.cwd()}/screenshots`;

export async function openBrowser() {
  mkdirSync(pictures, { recursive: true });
  return chromium.launch({
    executablePath: process.env.PLIANT_CHROMIUM,
    ignoreDefaultArgs: ["--hide-scrollbars"],
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

/** Opens a file from disk. `page.complaints` gathers errors and requests beyond the page itself. */
export async function openPage(browser, file, { width = screens.laptop, colors = "light", javaScript = true } = {}) {
  const context = await browser.newContext({
    viewport: { width, height: 900 }, colorScheme: colors, javaScriptEnabled: javaScript,
    permissions: ["clipboard-read", "clipboard-write"],
  });
  const page = await context.newPage();
  page.complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) page.complaints.push(message.text());
  });
  page.on("pageerror", (error) => page.complaints.push(String(error)));
  const url = pathToFileURL(file).href;
  page.on("request", (request) => {
    const is_inside = request.url() === url || /^(data|blob):/.test(request.url());
    if (!is_inside) page.complaints.push(`asks for ${request.url()}`);
  });
  await page.goto(url);
  return page;
}

/** Scrolls through the page, so that everything that waits to be seen is made. */
export async function seeAll(page) {
  const height = await page.evaluate(() => document.documentElement.scrollHeight);
  for (let y = 0; y < height; y += 700) {
    await page.evaluate((top) => scrollTo({ top, behavior: "instant" }), y);
    await page.waitForTimeout(60);
  }
  await page.evaluate(() => scrollTo({ top: 0, behavior: "instant" }));
  await page.waitForFunction(() => document.querySelectorAll(".chart-figure svg").length ===
    document.querySelectorAll(".chart-live canvas").length);
}

export async function keepPicture(page, name) {
  await page.screenshot({ path: `${pictures}/${name}.png`, fullPage: true });
}

/** Whatever reaches beyond the window, or beyond a box that neither shows nor scrolls it. */
export async function cutOff(page) {
  return page.evaluate(() => {
    const found = [];
    const width = document.documentElement.clientWidth;
    if (document.documentElement.scrollWidth > width) found.push(`the page is ${document.documentElement.scrollWidth} wide`);
    const scrolls = (element) => ["auto", "scroll"].includes(getComputedStyle(element).overflowX);
    for (const element of document.querySelectorAll("main *, nav *")) {
      if (element.closest("svg") && element.tagName !== "svg") continue;
      const box = element.getBoundingClientRect();
      if (box.width === 0 || element.closest("[hidden]")) continue;
      let scroller = element.parentElement;
      while (scroller && !scrolls(scroller)) scroller = scroller.parentElement;
      if (!scroller && (box.right > width + 1 || box.left < -1))
        found.push(`${element.tagName}.${element.className} from ${box.left} to ${box.right}`);
      const hides = getComputedStyle(element).overflowX === "hidden";
      if (hides && element.scrollWidth > element.clientWidth + 1) found.push(`${element.tagName}.${element.className} hides`);
    }
    return found;
  });
}

/** How many different colours a canvas shows. */
export async function colorsOf(canvas) {
  return canvas.evaluate((element) => {
    const { data } = element.getContext("2d").getImageData(0, 0, element.width, element.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
}

export function assertQuiet(page) {
  assert.deepEqual(page.complaints, []);
}

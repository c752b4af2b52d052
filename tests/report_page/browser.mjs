// A browser without a window, and what is asked of every page.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { mkdirSync } from "node:fs";
import { pathToFileURL } from "node:url";

// Installed in the build folder, which is the current one.
const { chromium } = createRequire(`${process.cwd()}/`)("playwright-core");

export const screens = { phone: 390, laptop: 1280, desktop: 1920 };
const pictures = `${process.cwd()}/screenshots`;

const sandbox = process.getuid() === 0 ? ["--no-sandbox"] : [];  // Chromium refuses to have one as root
const softwareWebGL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const smallMemory = ["--disable-dev-shm-usage"];  // containers share little

export async function openBrowser(webGL = softwareWebGL) {
  mkdirSync(pictures, { recursive: true });
  return chromium.launch({
    executablePath: process.env.PLIANT_CHROMIUM,
    ignoreDefaultArgs: ["--hide-scrollbars"],
    args: [...sandbox, ...smallMemory, ...webGL],
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
    if (message.type() === "error") page.complaints.push(message.text());
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

/** Scrolls to everything that waits to be seen, so that it is made. */
export async function seeAll(page) {
  for (const figure of await page.$$(".chart-figure:has(svg), .view-figure")) {
    await figure.evaluate((element) => element.scrollIntoView({ behavior: "instant" }));
    await figure.waitForSelector(".live canvas", { state: "attached" });
  }
  await page.evaluate(() => scrollTo({ top: 0, behavior: "instant" }));
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

/** The share of a canvas that does not look as its corner does. */
export async function coverageOf(canvas) {
  return canvas.evaluate((element) => {
    const { data } = element.getContext("2d").getImageData(0, 0, element.width, element.height);
    const pixels = new Uint32Array(data.buffer);
    return pixels.filter((color) => color !== pixels[0]).length / pixels.length;
  });
}

/** A number that stands for what a canvas shows. */
export async function pixelsOf(canvas) {
  return canvas.evaluate((element) => {
    const { data } = element.getContext("2d").getImageData(0, 0, element.width, element.height);
    return new Uint32Array(data.buffer).reduce((hash, color) => Math.imul(hash ^ color, 16777619), 2166136261);
  });
}

/** Asks every tenth of a second, twenty seconds long, until it holds: without a graphics card drawing takes a while. */
export async function eventually(holds, complaint) {
  for (let i = 0; i < 200; ++i) {
    if (await holds()) return;
    await new Promise((then) => setTimeout(then, 100));
  }
  assert.fail(complaint);
}

/** Does something that must change what a canvas shows. */
export async function changes(canvas, act, what) {
  const before = await pixelsOf(canvas);
  await act();
  await eventually(async () => await pixelsOf(canvas) !== before, `nothing changed: ${what}`);
}

/** Asks of a page what is asked of every page, on every screen and in both colours: nothing is cut off. */
export async function checkLayout(page, name) {
  await seeAll(page);
  for (const [screen, width] of Object.entries(screens))
    for (const colors of ["light", "dark"]) {
      await page.setViewportSize({ width, height: 900 });
      await page.emulateMedia({ colorScheme: colors });
      if (colors === "light" || screen === "laptop") await keepPicture(page, `${name}-${screen}-${colors}`);
      await setFolds(page, true);
      assert.deepEqual(await cutOff(page), [], `${screen}, ${colors}`);
      await setFolds(page, false);
    }
  await page.setViewportSize({ width: screens.laptop, height: 900 });
  await page.emulateMedia({ colorScheme: "light" });
}

async function setFolds(page, open) {
  await page.evaluate((value) => document.querySelectorAll("details").forEach((fold) => { fold.open = value; }), open);
}

export function assertQuiet(page) {
  assert.deepEqual(page.complaints, []);
}

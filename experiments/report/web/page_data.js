// What the page tells its scripts.

/** The data that html_data() wrote into an element. */
export function dataOf(element) {
  return JSON.parse(element.querySelector('script[type="application/json"]').textContent);
}

/** The value of a CSS variable, as the reader's colours are now. */
export function variable(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Calls `then` whenever the reader changes between light and dark. */
export function onOtherColors(then) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", then);
}

/** Calls `show` when an element comes near the window for the first time. */
export function whenSeen(element, show) {
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    show();
  }, { rootMargin: "300px" });
  observer.observe(element);
}

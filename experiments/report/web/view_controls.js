// The small parts that a view is operated with.

export function element(name, kind = "", ...children) {
  const made = document.createElement(name);
  if (kind) made.className = kind;
  made.append(...children);
  return made;
}

function input(type, values) {
  return Object.assign(element("input"), { type, ...values });
}

export function checkbox(name, value, checked, then) {
  const box = input("checkbox", { checked, value });
  box.addEventListener("change", () => then(box.checked));
  return element("label", "", box, name);
}

/** `options`: values and names. */
export function choice(name, options, then) {
  const list = element("select", "", ...options.map(([value, text]) => Object.assign(element("option", "", text), { value })));
  list.addEventListener("change", () => then(list.value));
  return element("label", "", name, list);
}

export function slider(name, max, value, then) {
  const range = input("range", { min: 0, max, step: 1, value });
  range.addEventListener("input", () => then(Number(range.value)));
  return element("label", "", name, range);
}

/** Takes numbers above 0 alone. */
export function numberField(name, unit, value, then) {
  const field = input("number", { min: 0, step: "any", value });
  field.addEventListener("change", () => {
    if (Number(field.value) > 0) then(Number(field.value));
  });
  return element("label", "", name, field, unit);
}

// The controls that panels consist of. Most are rows of a label and a control that shows the
// scene's present value.

// Makes an element with attributes. Attributes that begin with "on" are listeners. The children are
// elements or texts.
export function make(tag, attributes = {}, ...children) {
  const element = tag.startsWith("svg:") ? document.createElementNS("http://www.w3.org/2000/svg", tag.slice(4))
                                         : document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children);
  return element;
}

// Returns whether the element has the keyboard's focus, in the document or in a notebook's
// shadow tree.
export const isActive = (element) => element.getRootNode().activeElement === element;

let identifiers = 0;
const newId = () => `control-${++identifiers}`;

// Makes a row of a label and its controls. label: an element, or "" for a row without a label.
export const row = (label, ...controls) => make("div", { class: "row" }, label || make("span"), ...controls);

// Returns a number as a text of three or four significant digits.
export function shortNumber(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(2);
  return String(+value.toPrecision(size >= 1000 ? 5 : 3));
}

// A button that adds a key for numbers of the scene to the film. The button is visible while the panel of films is open; film_panel.js
// handles its event. write(): writes the default values of the numbers into the scene, where the scene does not have the numbers yet.
export const keyButton = (label, path, write) => make("button", {
  type: "button", class: "key-here", title: "Key of the film: this number at the chosen frame", "aria-label": `Add a key of ${label}`,
  onclick: (event) => event.currentTarget.dispatchEvent(new CustomEvent("halflight-key", { bubbles: true, detail: { paths: [path()].flat(), write } })),
}, "◆");

// A slider with its number beside it. get() returns the value, and set(value) changes it. exponential: equal
// movements of the slider change the number by equal factors. path(): returns the path of the number in the
// scene, or a list of paths, for keys of films. Returns { element, update }.
export function slider({ label, low, high, step = "any", unit = "", exponential = false, get, set, title, path }) {
  const toSlider = exponential ? Math.log : (x) => x, fromSlider = exponential ? Math.exp : (x) => x;
  const id = newId();
  const range = make("input", {
    type: "range", id, min: toSlider(low), max: toSlider(high), title,
    step: exponential ? (toSlider(high) - toSlider(low)) / 200 : step === "any" ? (high - low) / 200 : step,
    oninput: () => { set(fromSlider(+range.value)); update(); },
  });
  const number = make("input", {
    type: "number", class: "number", "aria-label": `${label}${unit ? ` in ${unit}` : ""}`, min: low, max: high,
    step: "any",
    onchange: () => {
      if (number.value !== "" && Number.isFinite(+number.value)) set(Math.min(Math.max(+number.value, low), high));
      number.value = shortNumber(get()); // this is done while the field has the focus, too, because set() may have changed the typed number
      update();
    },
  });
  function update() {
    const value = get();
    range.value = toSlider(Math.max(value, exponential ? low : -Infinity));
    range.setAttribute("aria-valuetext", `${shortNumber(value)} ${unit}`.trim());
    const filled = (range.value - range.min) / (range.max - range.min);
    range.style.setProperty("--filled", `${100 * Math.min(Math.max(filled, 0), 1)}%`);
    if (!isActive(number)) number.value = shortNumber(value);
  }
  const name = make("label", { for: id, title }, label);
  return { element: row(name, range, make("span", { class: "measure" }, number, make("span", { class: "unit" }, unit), ...(path ? [keyButton(label, path, () => set(get()))] : []))), update };
}

// Makes a choice of one value among several, as buttons side by side. choices: [[value, text],
// ...].
export function segments({ label, choices, get, set }) {
  const name = newId();
  const inputs = choices.map(([value, text]) => {
    const input = make("input", { type: "radio", name, value, id: newId(), onchange: () => set(value) });
    return [input, make("label", { for: input.id }, text)];
  });
  const update = () => { for (const [input] of inputs) input.checked = input.value === String(get()); };
  const group = make("div", { class: "segments", role: "radiogroup", "aria-label": label }, ...inputs.flat());
  return { element: row(make("span", { class: "name" }, label), group), update };
}

// Makes a drop-down list. choices: [[value, text], ...]; an entry { group, choices } is a named
// group of choices.
export function select({ label, choices, get, set, title }) {
  const id = newId(), option = ([value, text]) => make("option", { value }, text);
  const input = make("select", { id, title, onchange: () => set(input.value) },
    ...choices.map((choice) => (choice.group ? make("optgroup", { label: choice.group }, ...choice.choices.map(option)) : option(choice))));
  const update = () => { input.value = get(); };
  return { element: row(make("label", { for: id }, label), input), update };
}

// Makes a switch.
export function toggle({ label, get, set }) {
  const id = newId();
  const input = make("input", { type: "checkbox", id, role: "switch", onchange: () => set(input.checked) });
  return { element: row(make("label", { for: id }, label), input), update: () => { input.checked = get(); } };
}

export function color({ label, get, set }) {
  const id = newId();
  const input = make("input", { type: "color", id, oninput: () => set(input.value) });
  return { element: row(make("label", { for: id }, label), input), update: () => { input.value = get(); } };
}

export function button(text, action, attributes = {}) {
  return make("button", { type: "button", onclick: action, ...attributes }, text);
}

// Makes a row of numbered tabs, one of which is chosen, with buttons that add and remove a tab.
// count(): returns the number of tabs. chosen(): returns the index of the chosen tab.
export function tabs({ label, noun, count, chosen, choose, add, remove }) {
  const list = make("span", { role: "tablist", "aria-label": label });
  const more = button("+", add, { title: `Add: ${noun}`, "aria-label": `Add: ${noun}` });
  const less = button("−", remove, { title: `Remove this ${noun}`, "aria-label": `Remove this ${noun}` });
  function update() {
    while (list.childElementCount > count()) list.lastElementChild.remove();
    while (list.childElementCount < count()) {
      const n = list.childElementCount;
      list.append(button(`${n + 1}`, () => choose(n), { role: "tab", "aria-label": `${noun} ${n + 1}` }));
    }
    [...list.children].forEach((tab, n) => tab.setAttribute("aria-selected", String(n === chosen())));
    list.hidden = less.disabled = count() === 0;
  }
  return { element: make("div", { class: "tabs" }, list, more, less), update };
}

// Makes a section of the side bar that can be folded. Returns { element, body }.
export function section(title, open = true) {
  const body = make("div", { class: "section-body" });
  const element = make("details", { class: "section", open }, make("summary", { onclick: () => element.addEventListener("toggle", show, { once: true }) }, title), body);
  // An opened section is scrolled into view, so that its content is seen even if it is the last
  // section of the side bar.
  const show = () => { if (element.open) element.scrollIntoView({ block: "nearest" }); };
  return { element, body };
}

// The panel of measuring: the tools, and the list of all marks. While a tool is chosen, clicks in the picture
// and in slices set its points.

import { button, isActive, make, section } from "./controls.js";
import { captionOf, KINDS, measured } from "./marks.js";
import { length, subtract } from "./vector.js";

export function markPanel(viewer) {
  const { store, root, slices } = viewer, { element, body } = section("Measure", false);
  let kind = null, points = [], aimed = null; // aimed: the crosshair's position when the last point was made
  element.hidden = !viewer.channel.depth && !slices.available; // a channel without depth() cannot tell the point of the scene under a click

  const tools = Object.entries(KINDS).map(([name, { name: text }]) => button(text, () => change(kind === name ? null : name), { "aria-pressed": "false", "data-kind": name }));
  const hint = make("p", { class: "facts", role: "status" }), list = make("ul", { class: "files marks", "aria-label": "Marks" });
  const atCrosshair = button("point at the crosshair", () => addPoint(slices.cursor)), done = button("finish", finish);

  function choose(name) {
    [kind, points] = [name, []];
    root.classList.toggle("marking", kind !== null);
    store.setPage({});
  }

  // Chooses another tool, or no tool. A line that is being made is finished with the points that it
  // has.
  function change(name) {
    finish();
    if (name !== null) choose(name);
  }

  // Adds a point to the mark that is being made. Returns whether a tool has taken the point.
  function addPoint(point) {
    if (kind === null) return false;
    // The second click of a double click adds no point.
    if (points.length > 0 && length(subtract(point, points.at(-1))) === 0) return true;
    points = [...points, point];
    aimed = slices.available ? slices.cursor : null;
    if (points.length === KINDS[kind].most) finish();
    else store.setPage({});
    return true;
  }

  // Finishes the mark if it has enough points, and puts the tool away.
  function finish() {
    if (kind === null) return;
    const made = points.length >= KINDS[kind].least ? { kind, points, text: kind === "text" ? "Text" : "" } : null;
    const wasText = kind === "text";
    choose(null);
    if (made === null) return;
    store.setMarks(`add ${store.marks.length}`, [...store.marks, made]);
    element.open = true;
    if (wasText) list.querySelector("li:last-child input").select();
  }

  // Handles the key Enter in a slice: adds a point at the crosshair. If the crosshair has not moved since the last point, Enter finishes
  // the line. Returns whether a tool is chosen.
  function enter() {
    if (kind === null) return false;
    const hasMoved = aimed === null || length(subtract(slices.cursor, aimed)) > 0;
    if (points.length >= KINDS[kind].least && !hasMoved) finish();
    else addPoint(slices.cursor);
    return true;
  }

  // The functions of the tools that other files call.
  viewer.marking = {
    addPoint, enter, finish, cancel: () => choose(null), get isMaking() { return kind !== null; },
    get unfinished() { return points.length > 0 ? { kind, points, text: "" } : null; },
  };

  function line(n) {
    const mark = store.marks[n], label = `${KINDS[mark.kind].name} ${n + 1}`;
    const text = make("input", { type: "text", "aria-label": `Text of ${label}`, placeholder: KINDS[mark.kind].name, value: mark.text, oninput: () =>
      store.setMarks(`text ${n}`, store.marks.map((one, m) => (m === n ? { ...one, text: text.value } : one))) });
    const said = make("output", { class: "measured" });
    const show = button("show", () => slices.available && slices.moveTo(store.marks[n].points[0]), { "aria-label": `Crosshair to ${label}` });
    const remove = button("−", () => store.setMarks(`remove ${n}`, store.marks.filter((_, m) => m !== n)), { "aria-label": `Remove ${label}` });
    const update = () => {
      if (!isActive(text)) text.value = store.marks[n].text;
      said.textContent = measured(store.marks[n], viewer) === null ? "" : captionOf({ ...store.marks[n], text: "" }, viewer);
    };
    return { element: make("li", {}, text, said, show, remove), update, kind: mark.kind };
  }

  let lines = [];
  function update() {
    if (lines.length !== store.marks.length || lines.some((one, n) => one.kind !== store.marks[n].kind)) {
      lines = store.marks.map((_, n) => line(n));
      list.replaceChildren(...lines.map((one) => one.element));
    }
    lines.forEach((one) => one.update());
    tools.forEach((tool) => tool.setAttribute("aria-pressed", String(tool.dataset.kind === kind)));
    const missing = kind === null ? 0 : KINDS[kind].most - points.length;
    hint.textContent = kind === null ? "Choose a tool, then click in the picture or in a slice. Points can be dragged."
      : kind === "line" ? `Click the line's points; Enter, a double click or “finish” ends it. ${points.length} so far.`
        : `Click ${missing} ${missing === 1 ? "point" : "points"}${kind === "arrow" ? ", the tip last" : kind === "angle" ? ", the corner second" : ""}. Escape ends the tool.`;
    atCrosshair.hidden = kind === null || slices.layout === "picture";
    done.hidden = kind !== "line";
  }
  body.append(make("div", { class: "buttons", role: "group", "aria-label": "Tools for measuring" }, ...tools), hint, make("div", { class: "buttons" }, atCrosshair, done), list);
  update();
  return { element, update, updateView: update };
}

// The parts of a figure that are drawn over the picture: a scale bar, a legend, axes and marks. The viewer draws these parts as
// `halflight render` does. The scale bar, the legend and the axes lie over the picture at rest; the page draws the marks by itself
// (mark_overlay.js). A saved picture has all four parts. store.page.over says which parts the user wants.

import { isActive, make, row, select } from "./controls.js";
import { isAnatomical } from "./sections.js";
import { givenUnit, isUnitless } from "./units.js";

const LONG = 15000; // milliseconds for which a message says which part the program has left out

// Returns { elements, update, over, saved }. elements: rows of a panel. over(): returns { scaleBar, legend, axes, unit }, the
// parts that are wanted over the picture and can be drawn. saved(): returns the parts for a saved picture, which also have {
// marks }.
export function figureOverlay({ store, start, channel, failed, report, find, atRest, frames }) {
  const wanted = () => ({ scaleBar: false, legend: false, axes: "none", marks: true, ...(channel.overlay ? store.page.over : {}) });
  const want = (part) => store.setPage({ over: { ...wanted(), ...part } });
  const isVisible = (volume) => volume.visible !== false;
  // Returns the reason why no legend can be drawn; "": a legend can be drawn. A legend is a strip
  // of colours, which can only show a transfer function of one number.
  const noLegend = () => (!store.scene.volumes.some(isVisible) ? "A legend shows a visible volume."
    : store.scene.volumes.some((volume) => isVisible(volume) && volume.transfer_function?.second !== undefined) ? "A legend cannot show a transfer function of two numbers."
    : "");
  const lacksUnit = () => isUnitless({ store, start }) && givenUnit({ store, start }) === "";
  const kinds = [["none", "none"], ["arrows", "arrows"], ...(start.volumes.some(isAnatomical) ? [["letters", "letters of the body"]] : [])];
  const drawn = (withMarks) => {
    const { scaleBar, legend, axes, marks } = wanted(), bar = scaleBar === true && !lacksUnit(), unit = givenUnit({ store, start });
    const hasMarks = withMarks && channel.overlay && marks !== false && store.marks.length > 0;
    return {
      scaleBar: bar, legend: legend === true && noLegend() === "", axes: kinds.some(([kind]) => kind === axes) ? axes : "none",
      ...(hasMarks ? { marks: true } : {}), ...((bar || hasMarks) && unit ? { unit } : {}),
    };
  };
  const over = () => drawn(false), saved = () => drawn(true);

  // ---- over the picture ----

  const canvas = make("canvas", { class: "figure", "aria-hidden": "true", hidden: true });
  find("overlay").before(canvas);
  let shown = ""; // the result of told() for the drawing that the canvas shows; "": the canvas shows nothing

  // Returns a text of everything on which the drawing depends; "": no part is wanted.
  function told() {
    const asked = over(), { scene } = store;
    if (!asked.scaleBar && !asked.legend && asked.axes === "none") return "";
    return JSON.stringify([asked, scene.image, scene.volumes, scene.meshes ?? null, scene.camera]);
  }

  // The page hides its own axes and scale bar where the figure has axes and a scale bar.
  function show(what) {
    shown = what;
    canvas.hidden = what === "";
    find("view").classList.toggle("with-figure", what !== "");
  }

  // Shows a note of the program about the drawing, for example that there is no room for a legend. The note stays
  // in the panel and appears once over the picture.
  function say(note) {
    if (note !== "" && note !== said.textContent) report(note, LONG);
    said.textContent = note;
    said.hidden = note === "";
  }

  async function draw() {
    const what = told();
    if (!channel.overlay || what === shown) return;
    try {
      const answer = what === "" ? null : await channel.overlay(store.scene, over()), bitmap = answer && await createImageBitmap(answer.blob);
      if (what !== told()) return; // another drawing has been asked for since
      if (bitmap) {
        [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
        canvas.getContext("2d").drawImage(bitmap, 0, 0);
        bitmap.close();
      }
      show(bitmap ? what : "");
      say(answer?.note ?? "");
    } catch (error) {
      failed(error);
    }
  }

  atRest.push(draw);
  store.listen((_, name) => {
    if (shown !== "" && shown !== told()) show("");
    if ((name === "page" || name === "history") && frames().hasFinal(store.scene)) draw();
  });

  // ---- rows ----

  const box = (label, id, key) => {
    const input = make("input", { type: "checkbox", id, onchange: () => want({ [key]: input.checked }) });
    return { input, element: row(make("label", { for: id }, label), input) };
  };
  const unit = make("input", { type: "text", id: "unit", maxlength: 24, placeholder: "mm, µm, kpc …", oninput: () => store.setPage({ unit: unit.value.trim() }) });
  const unitRow = row(make("label", { for: "unit", title: "One unit of length of the volume's file" }, "Unit"), unit);
  const bar = box("Scale bar", "scale-bar", "scaleBar"), legend = box("Legend", "legend", "legend"), marks = box("Marks", "saved-marks", "marks");
  const axes = select({ label: "Axes", choices: kinds, get: () => over().axes, set: (name) => want({ axes: name }) });
  const said = make("p", { class: "facts", role: "status", hidden: true });
  const unknown = make("p", { class: "facts", id: "no-unit" }, "The volume's file tells no unit of length. With one, a scale bar can be drawn.");
  bar.input.setAttribute("aria-describedby", "no-unit");
  const elements = channel.overlay ? [unitRow, bar.element, unknown, legend.element, marks.element, axes.element, said] : [];

  function update() {
    const { scaleBar, legend: hasLegend, marks: hasMarks } = saved();
    unitRow.hidden = !isUnitless({ store, start });
    if (!isActive(unit)) unit.value = store.page.unit ?? "";
    bar.input.disabled = lacksUnit();
    unknown.hidden = !lacksUnit();
    bar.input.checked = scaleBar;
    legend.input.disabled = noLegend() !== "";
    legend.input.title = noLegend();
    legend.input.checked = hasLegend;
    marks.input.disabled = store.marks.length === 0;
    marks.input.title = marks.input.disabled ? "The scene has no marks. The panel “Measure” makes them." : "Rulers, angles, lines, arrows and texts in saved pictures";
    marks.input.checked = hasMarks === true;
    axes.update();
  }
  return { elements, update, over, saved };
}

// What a figure has over its picture: a scale bar, a legend and axes. The viewer draws them as `halflight render` does: they lie over the
// picture at rest, and are saved with it. What is wanted stands in store.page.over.

import { isActive, make, row, select } from "./controls.js";
import { isAnatomical } from "./sections.js";

// Returns { elements, update, over }. elements: rows of a panel. over(): what is wanted and can be drawn, { scaleBar, legend, axes, unit }.
export function figureOverlay({ store, start, channel, failed, find, atRest, frames }) {
  const wanted = () => ({ scaleBar: false, legend: false, axes: "none", ...(channel.overlay ? store.page.over : {}) });
  const want = (part) => store.setPage({ over: { ...wanted(), ...part } });
  const isVisible = (volume) => volume.visible !== false;
  // Why no legend can be drawn; "": one can. A strip of colours shows a function of one number.
  const noLegend = () => (!store.scene.volumes.some(isVisible) ? "A legend shows a visible volume."
    : store.scene.volumes.some((volume) => isVisible(volume) && volume.transfer_function?.second !== undefined) ? "A legend cannot show a transfer function of two numbers."
    : "");
  // Whether the file of a visible volume does not tell the unit of its lengths. A person can give the unit then.
  const isUnitless = () => start.volumes.some((volume, v) => volume?.unit === null && store.scene.volumes[v] && isVisible(store.scene.volumes[v]));
  const given = () => (isUnitless() ? String(store.page.unit ?? "") : "");
  const lacksUnit = () => isUnitless() && given() === "";
  const kinds = [["none", "none"], ["arrows", "arrows"], ...(start.volumes.some(isAnatomical) ? [["letters", "letters of the body"]] : [])];
  const over = () => {
    const { scaleBar, legend, axes } = wanted(), bar = scaleBar === true && !lacksUnit();
    return { scaleBar: bar, legend: legend === true && noLegend() === "", axes: kinds.some(([kind]) => kind === axes) ? axes : "none", ...(bar && given() ? { unit: given() } : {}) };
  };

  // ---- over the picture ----

  const canvas = make("canvas", { class: "figure", "aria-hidden": "true", hidden: true });
  find("overlay").before(canvas);
  let shown = ""; // what the canvas shows, as told() tells it; "": nothing

  // All on which the drawing depends; "": nothing is wanted.
  function told() {
    const asked = over(), { scene } = store;
    if (!asked.scaleBar && !asked.legend && asked.axes === "none") return "";
    const ofView = asked.scaleBar || asked.axes !== "none" ? scene.camera : null;
    return JSON.stringify([asked, scene.image, scene.volumes, scene.meshes ?? null, ofView]);
  }

  // The page's own axes and bar make room for those of the figure.
  function show(what) {
    shown = what;
    canvas.hidden = what === "";
    find("view").classList.toggle("with-figure", what !== "");
  }

  async function draw() {
    const what = told();
    if (!channel.overlay || what === shown) return;
    try {
      const blob = what === "" ? null : await channel.overlay(store.scene, over()), bitmap = blob && await createImageBitmap(blob);
      if (what !== told()) return; // another drawing has been asked for since
      if (bitmap) {
        [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
        canvas.getContext("2d").drawImage(bitmap, 0, 0);
        bitmap.close();
      }
      show(bitmap ? what : "");
    } catch (error) {
      failed(error);
    }
  }

  atRest.push(draw);
  store.listen((_, name) => {
    if (shown !== "" && shown !== told()) show("");
    if (name === "page" && frames().statistics.stage === "final") draw();
  });

  // ---- rows ----

  const box = (label, id, key) => {
    const input = make("input", { type: "checkbox", id, onchange: () => want({ [key]: input.checked }) });
    return { input, element: row(make("label", { for: id }, label), input) };
  };
  const unit = make("input", { type: "text", id: "unit", maxlength: 24, placeholder: "mm, µm, kpc …", oninput: () => store.setPage({ unit: unit.value.trim() }) });
  const unitRow = row(make("label", { for: "unit", title: "One unit of length of the volume's file" }, "Unit"), unit);
  const bar = box("Scale bar", "scale-bar", "scaleBar"), legend = box("Legend", "legend", "legend");
  const axes = select({ label: "Axes", choices: kinds, get: () => over().axes, set: (name) => want({ axes: name }) });
  const unknown = make("p", { class: "facts", id: "no-unit" }, "The volume's file tells no unit of length. With one, a scale bar can be drawn.");
  bar.input.setAttribute("aria-describedby", "no-unit");
  const elements = channel.overlay ? [unitRow, bar.element, unknown, legend.element, axes.element] : [];

  function update() {
    const { scaleBar, legend: hasLegend } = over();
    unitRow.hidden = !isUnitless();
    if (!isActive(unit)) unit.value = store.page.unit ?? "";
    bar.input.disabled = lacksUnit();
    unknown.hidden = !lacksUnit();
    bar.input.checked = scaleBar;
    legend.input.disabled = noLegend() !== "";
    legend.input.title = noLegend();
    legend.input.checked = hasLegend;
    axes.update();
  }
  return { elements, update, over };
}

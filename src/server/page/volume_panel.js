// The panel of a volume: its clip box and its shading; and the list that chooses among several volumes.

import { worldBox } from "./boxes.js";
import { hexOf, linearOf } from "./color.js";
import { button, color, keyButton, make, row, section, segments, select, shortNumber, slider, toggle } from "./controls.js";
import { absenceOf } from "./refinement.js";
import { seriesOf, seriesRow } from "./series.js";
import { measured } from "./slice_values.js";
import { symbolOf } from "./units.js";
import { length } from "./vector.js";

// Two sliders on one track: the two ends, along an axis, of the part of the volume that the clip
// box keeps.
function clipRow(axis, box, get, set, paths) {
  const name = "xyz"[axis], span = box.max[axis] - box.min[axis];
  const input = (end) => make("input", {
    type: "range", min: box.min[axis], max: box.max[axis], step: span / 400,
    "aria-label": `Clip ${name}, ${end === "min" ? "least" : "greatest"}`,
    oninput: (event) => {
      const clip = { min: [...get().min], max: [...get().max] }, gap = span / 200, value = +event.target.value;
      clip[end][axis] = end === "min" ? Math.min(value, clip.max[axis] - gap) : Math.max(value, clip.min[axis] + gap);
      set(clip, axis);
      update();
    },
  });
  const inputs = { min: input("min"), max: input("max") };
  const text = make("span", { class: "value" }), measure = make("span", { class: "measure wide" }, text, keyButton(`clip ${name}`, paths, () => set(get(), axis)));
  const track = make("span", { class: "double" }, inputs.min, inputs.max);
  function update() {
    const ends = ["min", "max"].map((end) => get()[end][axis]);
    ["min", "max"].forEach((end, n) => { inputs[end].value = ends[n]; });
    text.textContent = ends.map(shortNumber).join(" … ");
    ends.forEach((value, n) => track.style.setProperty(n === 0 ? "--from" : "--to", (value - box.min[axis]) / span));
  }
  return { element: row(make("span", { class: `name axis-name axis-${axis}` }, `Clip ${name}`), track, measure), update };
}

// Makes the list above all panels, which is visible if there are several volumes. The list chooses
// the volume that the panels edit.
export function volumeChooser({ store, current }) {
  const { element, update } = select({
    label: "Volume", choices: store.scene.volumes.map((v, n) => [String(n), v.name ?? (v.file ?? "shapes").split("/").pop()]),
    get: () => String(current.volume), set: (n) => current.choose("volume", +n),
  });
  return { element: make("div", { class: "chooser", hidden: store.scene.volumes.length < 2 }, element), update, rebuild: update };
}

export function volumePanel(viewer) {
  const { store, start, current, overlay, channel, report, waits } = viewer, { element, body } = section("Volume", false);
  const volume = () => store.scene.volumes[current.volume];
  const change = (name, set) => store.changeVolume(current.volume, name, set);
  let parts = [];

  function materialSliders() {
    const limits = [["ambient", "Ambient", 0, 2], ["diffuse", "Diffuse", 0, 2], ["specular", "Specular", 0, 2], ["shininess", "Shininess", 1, 200], ["emission", "Emission", 0, 4]];
    return limits.map(([key, label, low, high]) => slider({
      label, path: () => `volumes.${current.volume}.material.${key}`, low, high, get: () => volume().material?.[key] ?? 0,
      set: (value) => change(key, (v) => ({ ...v, material: { ...v.material, [key]: value } })),
    }));
  }

  // Makes the controls of a medium's scattering: the strength and the colour of the albedo, and the
  // anisotropy.
  function scatteringParts() {
    const scattering = () => volume().scattering ?? {}, albedo = () => scattering().albedo ?? [1, 1, 1];
    const level = () => Math.max(...albedo()), tint = () => (level() > 0 ? albedo().map((c) => c / level()) : [1, 1, 1]);
    const set = (name, part) => change(name, (v) => ({ ...v, scattering: { ...v.scattering, ...part } }));
    const ofTint = (shade, most) => shade.map((c) => (most * c) / Math.max(...shade, 1e-9));
    return [
      toggle({ label: "Multiple scattering", get: () => scattering().multiple === true, set: (on) => set("multiple", { multiple: on }) }),
      slider({
        label: "Forward", path: () => `volumes.${current.volume}.scattering.anisotropy`, low: -0.95, high: 0.95, title: "Where a medium scatters light to: above 0 forward, below 0 back, 0 evenly",
        get: () => scattering().anisotropy ?? 0, set: (g) => set("anisotropy", { anisotropy: Math.abs(g) < 0.02 ? 0 : g }),
      }),
      slider({
        label: "Albedo", path: () => `volumes.${current.volume}.scattering.albedo`, low: 0, high: 1, title: "The fraction of light that a medium scatters; the rest is lost",
        get: level, set: (most) => set("albedo", { albedo: ofTint(tint(), most) }),
      }),
      color({ label: "Tint", get: () => hexOf(tint()), set: (hex) => set("tint", { albedo: ofTint(linearOf(hex), level()) }) }),
    ];
  }

  // Turns the volume into a label map: values then are names of things, not amounts. Each thing gets a
  // smooth surface, a name and a colour.
  async function showLabels() {
    const { transfer_function: _, iso: __, shading: ___, ...bare } = volume(), index = current.volume;
    const volumes = store.scene.volumes.map((v, n) => (n === index ? { ...bare, labels: true } : v));
    try {
      const complete = await waits(channel.completeScene({ ...store.scene, volumes }));
      store.changeVolume(index, "labels", () => complete.volumes[index]);
    } catch (error) {
      report(error.message);
    }
  }

  function build() {
    element.hidden = volume() === undefined;
    if (element.hidden) return;
    const about = start.volumes[current.volume], box = worldBox(about);
    const clip = () => volume().clip ?? box;
    const rows = [0, 1, 2].map((axis) => clipRow(axis, box, clip, (changed, a) => change(`clip ${a}`, (v) => ({ ...v, clip: changed })), () => ["min", "max"].map((end) => `volumes.${current.volume}.clip.${end}.${axis}`)));
    const reset = row("", button("whole volume", () => change("clip reset", ({ clip: _, ...v }) => v)));
    const shading = segments({
      label: "Shading", choices: [["phong", "Surface"], ["none", "Medium"], ["flat", "Flat"]],
      get: () => volume().shading ?? "phong", set: (value) => change("shading", (v) => ({ ...v, shading: value })),
    });
    const visible = toggle({ label: "Visible", get: () => volume().visible !== false, set: (on) => change("visible", (v) => ({ ...v, visible: on })) });
    const scattering = scatteringParts();
    const asLabels = row("", button("show as labels", showLabels, { title: "Where voxels are numbers of things" }));
    const labelled = { element: asLabels, update: () => { asLabels.hidden = volume().labels !== undefined || about.type.startsWith("float"); } };
    const casts = toggle({ label: "Casts shadows", get: () => volume().casts_shadow !== false, set: (on) => change("casts", (v) => ({ ...v, casts_shadow: on })) });
    const material = materialSliders();
    const unit = about.unit ? ` ${symbolOf(about.unit)}` : "", edges = about.axes.map((axis) => shortNumber(length(axis))).join(" × ");
    const series = seriesRow(viewer, about, volume().file), own = measured(about); // the range of the file's values
    const facts = make("p", { class: "facts" }, `${about.dimensions.join(" × ")} voxels of ${edges}${unit}, ${own.type}, values ${own.range.map(shortNumber).join(" to ")}${absenceOf(about) ? `; ${absenceOf(about)}` : ""}${seriesOf(about) ? `; ${seriesOf(about)}` : ""}`);
    parts = [...rows, labelled, shading, ...scattering, visible, casts, ...material];
    body.replaceChildren(facts, ...series, ...rows.map((r) => r.element), reset, labelled.element, shading.element,
      ...[...material, ...scattering, visible, casts].map((part) => part.element));
    update();
  }
  const update = () => parts.forEach((part) => part.update());
  element.addEventListener("toggle", () => { overlay.showsBox = element.open; });
  build();
  return { element, update, rebuild: build };
}

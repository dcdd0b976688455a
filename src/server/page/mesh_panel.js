// The panel of the scene's meshes. Each mesh has an eye, a colour, its file's name and an opacity.

import { hexOf, linearOf } from "./color.js";
import { button, isActive, make, section } from "./controls.js";

const nameOf = (mesh, number) => mesh.file?.split("/").pop() ?? `mesh ${number + 1}`;

// Makes the row of one mesh. get(): returns the mesh. change(name, part): changes the mesh.
function meshRow({ name, get, change }) {
  const eye = button("", () => change("eye", { visible: get().visible === false }), { class: "eye", "aria-label": `Show ${name}` });
  const shade = make("input", { type: "color", "aria-label": `Colour of ${name}`, oninput: () => change("color", { color: linearOf(shade.value) }) });
  const opacity = make("input", {
    type: "number", min: 0, max: 1, step: 0.1, "aria-label": `Opacity of ${name}`,
    onchange: () => {
      if (opacity.value !== "") change("opacity", { opacity: Math.min(Math.max(+opacity.value, 0), 1) });
      update();
    },
  });
  function update() {
    const mesh = get();
    eye.setAttribute("aria-pressed", String(mesh.visible !== false));
    shade.value = hexOf(mesh.color ?? [1, 1, 1]);
    if (!isActive(opacity)) opacity.value = +(mesh.opacity ?? 1).toFixed(3);
  }
  return { element: make("li", {}, eye, shade, make("span", { class: "file" }, name), opacity), update };
}

export function meshPanel({ store }) {
  const { element, body } = section("Meshes");
  const list = make("ul", { class: "files labels" }), meshes = () => store.scene.meshes ?? [];
  let rows = [];
  const change = (number, name, part) => store.change(`mesh ${number} ${name}`, (scene) => ({ ...scene, meshes: scene.meshes.map((mesh, m) => (m === number ? { ...mesh, ...part } : mesh)) }));
  function update() {
    element.hidden = meshes().length === 0;
    if (rows.length !== meshes().length) {
      rows = meshes().map((mesh, n) => meshRow({ name: nameOf(mesh, n), get: () => meshes()[n], change: (name, part) => change(n, name, part) }));
      list.replaceChildren(...rows.map((one) => one.element));
    }
    rows.forEach((one) => one.update());
  }
  body.append(list);
  update();
  return { element, update };
}

// Out of the viewer: the picture, the scene, the command that renders it.

import { button, isActive, make, row, section, select } from "./controls.js";

const stem = (title) => title.replace(/\.(gz|json|nrrd|nhdr|nii|mha|mhd|vti|vtk|raw|npy|png)$/gi, "").replace(/\.nii$/i, "") || "picture";

// Shell words in single quotes where they need any.
const quoted = (word) => (/^[\w./+:=-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

// The scene file's text: what `halflight render` takes.
export const sceneText = (scene) => JSON.stringify(scene, null, 2) + "\n";

export const commandLine = (title) => `halflight render ${quoted(`${stem(title)}.json`)} -o ${quoted(`${stem(title)}.png`)}`;

function download(blob, name) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export function exportPanel({ store, start, channel, report }) {
  const { element, body } = section("Save", false);
  const name = stem(start.title);
  let format = "png";
  const side = (label) => make("input", { type: "number", min: 16, max: 8192, step: 1, "aria-label": label });
  const width = side("Width in pixels"), height = side("Height in pixels");
  const kind = select({
    label: "Format", choices: [["png", "PNG"], ["png16", "PNG, 16 bits"], ["exr", "EXR, linear float"]],
    get: () => format, set: (value) => { format = value; },
  });
  const transparent = make("input", { type: "checkbox", id: "transparent" });

  async function savePicture() {
    const scene = structuredClone(store.scene), image = scene.image;
    image.width = Math.round(+width.value) || image.width;
    image.height = Math.round(+height.value) || image.height;
    if (transparent.checked) image.background = "transparent";
    save.disabled = true;
    report(`rendering ${image.width} × ${image.height} …`);
    try {
      const type = format === "exr" ? "exr" : "png";
      const frame = await channel.fetchFrame(scene, { format: type, depth: format === "png16" ? 16 : 8, lane: "-save" });
      if (frame !== null) download(frame.blob, `${name}.${type}`);
      report(frame === null ? "cancelled by another save" : `saved ${name}.${type}`);
    } catch (error) {
      report(error.message);
    }
    save.disabled = false;
  }

  async function copyCommand() {
    const text = commandLine(start.title);
    try {
      await navigator.clipboard.writeText(text);
      report("copied: save the scene beside it");
    } catch {
      report(text);
    }
  }

  const save = button("save picture", savePicture, { class: "primary" });
  const saveScene = () => {
    download(new Blob([sceneText(store.scene)], { type: "application/json" }), `${name}.json`);
    report(`saved ${name}.json`);
  };
  body.append(
    row(make("span", { class: "name" }, "Size"), make("span", { class: "pair" }, width, "×", height)), kind.element,
    row(make("label", { for: "transparent" }, "Transparent"), transparent), row("", save),
    row(make("span", { class: "name" }, "Scene"), make("span", { class: "buttons" }, button("save scene", saveScene), button("copy command", copyCommand))),
    make("p", { class: "facts" }, "The scene file renders to the same picture, byte for byte: ", make("code", {}, commandLine(start.title))));
  function update() {
    for (const [input, key] of [[width, "width"], [height, "height"]])
      if (!isActive(input) && !input.value) input.placeholder = store.scene.image[key];
    kind.update();
  }
  update();
  return { element, update, savePicture, saveScene };
}

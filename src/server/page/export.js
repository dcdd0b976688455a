// The panel that exports from the viewer: the picture, the scene, and the command that renders the
// picture.

import { reshaped } from "./camera.js";
import { button, isActive, make, row, section, select } from "./controls.js";
import { figureOverlay } from "./figure_overlay.js";

// Returns a title without the extensions of a file name: the extension of a compression and the
// extension of a format.
export const stem = (title) => title.replace(/(?<=.)\.(gz|bz2|xz|zst)$/i, "").replace(/(?<=.)\.[a-z][a-z0-9]*$/i, "") || "picture";

// Returns a word as a shell reads it, in single quotes if the word needs quotes.
export const quoted = (word) => (/^[\w./+:=-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

// Returns the name of a file after the title, quoted for a shell. A name that begins with "-" gets
// "./" in front, so that no program takes the name for an option.
export const fileWord = (title, ending) => quoted(`${stem(title)}${ending}`.replace(/^-/, "./-"));

// Returns the text of the scene file that `halflight render` reads.
export const sceneText = (scene) => JSON.stringify(scene, null, 2) + "\n";

// Returns a command that renders the scene. The command needs no file but the scene's volumes, because the scene is the command's standard input.
// over: { scaleBar, legend, axes, marks, unit }: the parts of a figure that are drawn over the picture (figure_overlay.js), and the unit of
// lengths, used if the files tell no unit. In a perspective picture, the length of the scale bar is right at the depth of the camera's target.
export const commandLine = (scene, title, { scaleBar = false, legend = false, axes = "none", marks = false, unit = "" } = {}) =>
  `halflight render - -o ${fileWord(title, ".png")}${unit ? ` --unit ${quoted(unit)}` : ""}${scaleBar ? ` --scale-bar auto${scene.camera.type === "orthographic" ? "" : "@target"}` : ""}${legend ? " --legend auto" : ""}${axes === "none" ? "" : ` --axes ${axes}`}${marks ? " --marks" : ""} <<'END'\n${sceneText(scene)}END\n`;

// Returns the call of annotate() for a Python program that draws the same parts of a figure; "" if
// there are none.
const annotated = ({ scaleBar = false, legend = false, axes = "none", marks = false, unit = "" }) => {
  const words = [...(scaleBar ? ["scale_bar=True", 'depth="target"'] : []), ...(unit ? [`unit=${JSON.stringify(unit)}`] : []), ...(legend ? ["legend=True"] : []), ...(axes === "none" ? [] : [`axes=${JSON.stringify(axes)}`]), ...(marks ? ["marks=True"] : [])];
  return words.length > 0 ? `.annotate(${words.join(", ")})` : "";
};

export const pythonProgram = (scene, title, over = {}) =>
  `import halflight\n\nscene = halflight.Scene.from_json(r"""${sceneText(scene).replaceAll('"""', '\\"\\"\\"')}""")\n` +
  `halflight.Renderer().render(scene)${annotated(over)}.save("${stem(title).replaceAll(/["\\]/g, "_")}.png")\n`;

export function download(blob, name) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// Returns a function that copies a text to the clipboard. If the browser does not allow this, the
// function saves the text as a file.
export function copier(report, store) {
  return async (text, what) => {
    try {
      await navigator.clipboard.writeText(text);
      report(`${what} is in the clipboard`);
    } catch {
      const extension = { "the scene": "json", "the program": "py" }[what] ?? "sh";
      download(new Blob([text], { type: "text/plain" }), `${stem(store.title)}.${extension}`);
      report(`${what} is saved, as the clipboard is not allowed`);
    }
  };
}

export function exportPanel(viewer) {
  const { store, channel, report, failed, copy } = viewer;
  const { element, body } = section("Save", false);
  const name = () => stem(store.title);
  let format = "png", purpose = "";
  const side = (label) => make("input", { type: "number", min: 16, max: 8192, step: 1, "aria-label": label });
  const width = side("Width in pixels"), height = side("Height in pixels");
  const kind = select({
    label: "Format", choices: [["png", "PNG"], ["png16", "PNG, 16 bits"], ["exr", "EXR, linear float"]],
    get: () => format, set: (value) => { format = value; update(); },
  });
  // The list that chooses the picture's width and height by the picture's purpose: a multiple of
  // the shown size, or a width in print.
  const sizes = select({
    label: "For", choices: [["", "these pixels"], ["1", "as seen"], ["2", "twice as seen"], ["4", "four times as seen"], ["8.5cm", "8.5 cm at 300 dpi"], ["17cm", "17 cm at 300 dpi"]],
    get: () => purpose, set: (choice) => {
      purpose = choice;
      followPurpose();
    },
  });
  function followPurpose() {
    const { image } = store.scene, factor = purpose.endsWith("cm") ? (parseFloat(purpose) / 2.54) * 300 / image.width : +purpose;
    if (factor > 0) [width.value, height.value] = [Math.round(image.width * factor), Math.round(image.height * factor)];
  }
  // A typed width or height sets the purpose to "these pixels".
  [width, height].forEach((input) => input.addEventListener("input", () => { purpose = ""; sizes.update(); }));
  const transparent = make("input", { type: "checkbox", id: "transparent" });
  const bare = make("input", { type: "checkbox", id: "bare", title: "A PNG without the scene, and without the names of its files" });

  const figure = figureOverlay(viewer), same = make("p", { class: "facts" }), plain = make("p", { class: "facts", id: "plain-format", hidden: true }, "What is drawn over the picture is saved in PNGs of 8 bits alone.");
  const drawsOver = () => { const { scaleBar, legend, axes, marks } = figure.saved(); return scaleBar || legend || axes !== "none" || marks === true; };
  const over = () => (format === "png" && drawsOver() ? figure.saved() : {});

  async function savePicture() {
    const scene = structuredClone(store.file), image = scene.image, seen = { width: image.width, height: image.height };
    image.width = Math.round(+width.value) || image.width;
    image.height = Math.round(+height.value) || image.height;
    // The camera is changed so that the saved picture contains the part of the scene that the
    // viewer shows, whatever the picture's shape.
    scene.camera = reshaped(scene.camera, seen, image);
    if (transparent.checked) [image.background_transparent, image.background_sky] = [true, false];
    save.disabled = true;
    report(`rendering ${image.width} × ${image.height} …`);
    try {
      const type = format === "exr" ? "exr" : "png";
      const frame = await channel.fetchFrame(scene, { format: type, depth: format === "png16" ? 16 : 8, metadata: !bare.checked, lane: "-save", finest: true, ...over() });
      if (frame !== null) download(frame.blob, `${name()}.${type}`);
      report(frame === null ? "cancelled by another save" : `saved ${name()}.${type}${frame.note ? `: ${frame.note}` : ""}`);
    } catch (error) {
      failed(error);
    }
    save.disabled = false;
  }

  const save = button("save picture", savePicture, { class: "primary" });
  const saveScene = () => {
    download(new Blob([sceneText(store.shownFile)], { type: "application/json" }), `${name()}.json`);
    report(`saved ${name()}.json`);
  };
  body.append(
    row(make("span", { class: "name" }, "Size"), make("span", { class: "pair" }, width, "×", height)), sizes.element, kind.element,
    row(make("label", { for: "transparent" }, "Transparent"), transparent),
    row(make("label", { for: "bare" }, "No metadata"), bare), ...figure.elements, plain, row("", save),
    row(make("span", { class: "name" }, "Scene"), make("span", { class: "buttons" }, button("save scene", saveScene),
      button("copy scene", () => copy(sceneText(store.shownFile), "the scene")))),
    row("", make("span", { class: "buttons" },
      button("copy command", () => copy(commandLine(store.shownFile, store.title, figure.saved()), "the command")),
      button("copy Python", () => copy(pythonProgram(store.shownFile, store.title, figure.saved()), "the program")))),
    same);
  function update() {
    followPurpose();
    for (const [input, key] of [[width, "width"], [height, "height"]])
      if (!isActive(input) && !input.value) input.placeholder = store.scene.image[key];
    kind.update();
    figure.update();
    plain.hidden = !drawsOver() || format === "png";
    same.textContent = `Each of them makes the same picture, ${drawsOver() ? "pixel for pixel" : "byte for byte"}.`;
  }
  update();
  return { element, update, updateView: update, savePicture, saveScene };
}

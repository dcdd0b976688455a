// The planes beside the picture: their layout, the crosshair that links the planes, their window and level, and their
// content. A person's choices are members of store.page: layout, plane (beside the picture), cursor (a point of the
// scene), drag (of DRAGS), windows (by volume: [low, high]), thickness (a length of the scene), blend, showLabels,
// showIsolines, oblique (a camera that the oblique plane keeps; null: it follows the picture's).

import { middle, placed, worldBox } from "./boxes.js";
import { projector } from "./camera.js";
import { make } from "./controls.js";
import { cutsOf, sectionsOf } from "./cut_sections.js";
import { Marks } from "./mark_overlay.js";
import { pick } from "./pick.js";
import { holds, planeOf, PLANES, voxelAt } from "./sections.js";
import { SliceValues, automaticWindow, labelSources, measured, sourceVolume } from "./slice_values.js";
import { SliceView } from "./slice_view.js";

export const LAYOUTS = [["picture", "Picture"], ["beside", "One slice"], ["four", "Four-up"]];
// What a drag by the left button or by one finger does in a slice.
export const DRAGS = [["cursor", "Crosshair"], ["window", "Window"], ["planes", "Planes"], ["pan", "Pan"]];
const STILL = 4; // pixels that the pointer may move during a click
const ARM = 16; // pixels of the crosshair in the picture

export class Slices {
  #viewer;
  #place;
  #views;
  #values = new Map(); // the SliceValues of each plane, by the plane's name
  #marks;
  // The crosshair in the picture.
  #cross = make("svg:path", { class: "crosshair in-picture", "aria-hidden": "true" });
  #reading = null; // the text of the crosshair's position and sources for which readouts were requested
  #readout = null;
  #reads = 0; // number of requested readouts that have not arrived
  #onReadout = () => {};
  #pickNumber = 0;

  // place: the element around the picture, to which the planes are added. picture: the picture's element.
  constructor(viewer, place, picture) {
    this.#viewer = viewer;
    this.#place = place;
    this.#views = PLANES.map((name) => new SliceView(this, name));
    this.#marks = new Marks(viewer);
    place.append(...this.#views.map((view) => view.element));
    viewer.find("overlay").append(this.#cross);
    this.#followClicks(picture);
    viewer.store.listen(() => this.update());
    new ResizeObserver(() => this.update()).observe(place);
  }

  get available() { return this.#viewer.channel.slice !== undefined && this.#viewer.start.volumes.length > 0; }
  get layout() { return this.available ? (this.#viewer.store.page.layout ?? "picture") : "picture"; }
  get plane() { return this.#viewer.store.page.plane ?? "axial"; }
  // The action of a drag. While a mark is being made, clicks set the mark's points, whatever action
  // the user has chosen for drags.
  get drag() { return this.#viewer.marking?.isMaking ? "cursor" : (this.#viewer.store.page.drag ?? "cursor"); }
  get thickness() { return this.#viewer.store.page.thickness ?? 0; }
  get blend() { return this.#viewer.store.page.blend ?? "maximum"; }

  // { volume, grid, transform } of the volume that the slices show; null: there is no such volume.
  get source() {
    const { store, start } = this.#viewer, volume = sourceVolume(this.#viewer);
    return volume < 0 || !start.volumes[volume] ? null : { volume, grid: start.volumes[volume], transform: store.scene.volumes[volume].transform };
  }

  get cursor() {
    const { store } = this.#viewer, { grid, transform } = this.source;
    return store.page.cursor ?? placed(middle(worldBox(grid)), transform);
  }

  get window() {
    const { store, start } = this.#viewer, { volume } = this.source;
    return store.page.windows?.[volume] ?? automaticWindow(measured(start.volumes[volume]));
  }

  set window(ends) {
    const { store } = this.#viewer, { [this.source.volume]: _, ...rest } = store.page.windows ?? {};
    store.setPage({ windows: ends === null ? rest : { ...rest, [this.source.volume]: ends } });
  }

  // Changes window and level by a drag. right, down: the movement as fractions of the plane's sides. A
  // movement to the right widens the window; a movement upwards raises the level.
  changeWindow(right, down) {
    const [low, high] = this.window, [least, greatest] = measured(this.source.grid).range, whole = Math.max(greatest - least, 1e-30);
    const width = Math.max((high - low) * Math.exp(2 * right), whole * 1e-5), level = (low + high) / 2 - down * Math.max(high - low, whole * 1e-3);
    this.window = [level - width / 2, level + width / 2];
  }

  moveTo(point) {
    this.#viewer.store.setPage({ cursor: point });
  }

  // Returns whether the mark that is being made has taken the point.
  addPoint(point) { return this.#viewer.marking?.addPoint(point) ?? false; }
  enter() { return this.#viewer.marking?.enter() ?? false; }
  finishMark() { this.#viewer.marking?.finish(); }

  // ---- clicks in the picture ----

  #followClicks(picture) {
    let from = null;
    picture.addEventListener("pointerdown", (event) => { from = event.button === 0 && event.isPrimary && !event.shiftKey && !event.ctrlKey ? event : null; });
    // event.detail is the number of successive clicks: the second click of a double click adds no
    // point.
    picture.addEventListener("click", (event) => {
      if (event.detail <= 1 && from !== null && Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) <= STILL) this.#clicked(event, picture);
      from = null;
    });
    picture.addEventListener("dblclick", () => this.finishMark());
  }

  // Handles a click in the picture: moves the crosshair, or sets the next point of a mark, to the
  // point of the scene that the clicked pixel shows.
  async #clicked(event, picture) {
    const { channel, store, report, marking } = this.#viewer, box = picture.getBoundingClientRect(), number = ++this.#pickNumber;
    if (!channel.depth || (this.layout === "picture" && !marking?.isMaking)) return;
    try {
      const point = await pick(channel, store.scene, [event.clientX - box.left, event.clientY - box.top], box.width, box.height);
      if (number !== this.#pickNumber) return; // a later click replaces this click
      if (point === null) report("Nothing is seen there.");
      else if (!this.addPoint(point)) this.moveTo(point);
    } catch (error) {
      this.#viewer.failed(error);
    }
  }

  // ---- what is shown ----

  // Called when volumes were replaced by their finer resolutions.
  refine() {
    for (const values of this.#values.values()) values.forget();
    this.#reading = null;
    this.update();
  }

  // Makes the layout and the planes follow the state of the store.
  update() {
    const { layout } = this, shown = layout === "four" ? 3 : layout === "beside" ? 1 : 0;
    this.#place.dataset.layout = layout;
    this.#views.forEach((view, n) => {
      view.element.hidden = n >= shown;
      view.name = layout === "beside" ? this.plane : PLANES[n];
    });
    this.#marks.drawPicture();
    this.#drawCross(shown > 0);
    if (shown === 0) return;
    for (const view of this.#views.slice(0, shown)) {
      this.#want(view.name);
      view.draw();
    }
    this.#read();
  }

  #drawCross(shows) {
    const { store, find } = this.#viewer, svg = find("overlay"), [width, height] = [svg.clientWidth, svg.clientHeight];
    const at = shows && height > 0 ? projector(store.scene.camera, width, height)(this.cursor) : null;
    this.#cross.setAttribute("d", at === null ? "" : `M${at[0] - ARM} ${at[1]}h${ARM - 4}m8 0h${ARM - 4}M${at[0]} ${at[1] - ARM}v${ARM - 4}m0 8v${ARM - 4}`);
  }

  // Whether requested values of planes or of the crosshair have not arrived yet.
  get isBusy() { return this.#reads > 0 || [...this.#values.values()].some((values) => values.isBusy); }

  view(name) { return this.#views.find((view) => view.name === name); }
  shown(name) { return this.#values.get(name)?.shown ?? null; }
  drawMarks(view) { this.#marks.drawPlane(view); }

  // Returns the sections of the source volume's cuts with a plane.
  sections(plane) {
    const { source } = this;
    return sectionsOf(cutsOf(this.#viewer.store.scene, source.volume), plane, source);
  }

  #want(name) {
    const { store, channel } = this.#viewer, { source, cursor, thickness, blend } = this;
    if (!this.#values.has(name))
      this.#values.set(name, new SliceValues(channel, () => this.#views.forEach((view) => { if (view.name === name) view.draw(); }), (error) => this.#viewer.failed(error)));
    const plane = planeOf(name, { ...source, cursor, thickness, camera: store.page.oblique ?? store.scene.camera });
    this.#values.get(name).want(plane, source, labelSources(this.#viewer, source.volume), blend, this.#surfaces.length > 0);
  }

  // The isosurfaces of the source volume that are drawn as isolines.
  get #surfaces() {
    const { store } = this.#viewer;
    return store.page.showIsolines ?? true ? (store.scene.volumes[this.source.volume].iso ?? []) : [];
  }

  // Returns the settings that determine the look of planes besides their values. `key` is a text
  // that differs if and only if the look differs.
  look() {
    const { store } = this.#viewer, { source, window } = this, surfaces = this.#surfaces, { showLabels = true } = store.page;
    const sources = labelSources(this.#viewer, source.volume), maps = showLabels ? sources : [];
    const isAlone = sources.some((map) => map.volume === source.volume && map.of === "voxels");
    return { window, maps, surfaces, isAlone, key: JSON.stringify([window, maps.map((map) => map.labels), surfaces]) };
  }

  // ---- the crosshair's own value ----

  // The listener is called when the readout changes: the voxel under the crosshair, its value and its
  // labels.
  set onReadout(listener) { this.#onReadout = listener; }
  get readout() { return this.#readout; }

  async #read() {
    const { channel } = this.#viewer, { source, cursor } = this, key = JSON.stringify([source.volume, cursor]);
    if (this.#reading === key) return;
    this.#reading = key;
    this.#reads++;
    const index = voxelAt(source.grid, source.transform, cursor);
    try {
      const read = async ({ volume, of = "voxels", grid, transform }) => {
        const voxel = voxelAt(grid, transform, cursor);
        if (!holds(grid, voxel)) return NaN;
        return (await channel.slice({ volume, of, width: 1, height: 1, origin: voxel, across: [1, 0, 0], down: [0, 1, 0], through: [0, 0, 1] })).values[0];
      };
      const value = await read(source), labels = [];
      for (const map of labelSources(this.#viewer, source.volume)) {
        const found = await read(map), label = map.labels.find((one) => one.value === found);
        if (label) labels.push(label.name ?? `label ${label.value}`);
      }
      if (this.#reading !== key) return; // the crosshair has moved meanwhile
      this.#readout = { voxel: index, inside: holds(source.grid, index), value, labels };
      this.#onReadout();
    } catch (error) {
      this.#reading = null;
      this.#viewer.failed(error);
    } finally {
      this.#reads--;
    }
  }
}

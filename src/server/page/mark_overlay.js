// The marks that are drawn over the picture and over slices, and the handles of their points.

import { axes, projector, worldHeight } from "./camera.js";
import { make } from "./controls.js";
import { captionOf, KINDS } from "./marks.js";
import { PictureHandles } from "./picture_handles.js";
import { add, scale } from "./vector.js";

const HEAD = 9; // pixels of an arrow's head
const DOT = 4; // pixels; radius
const TEXT_HEIGHT = 13, TEXT_WIDTH = 8; // pixels: the line height, and the greatest width of a letter, of .mark-text in style.css
const MOST_STEPS = 8; // the greatest number of lines by which a text moves down to avoid other texts
const KEY_REACH = 0.25; // fraction of the height of the shown area; an arrow key moves a point by a fiftieth of this length

// The head of an arrow that points to [x, y].
function head([fromX, fromY], [x, y]) {
  const far = Math.hypot(x - fromX, y - fromY) || 1, [dx, dy] = [((x - fromX) / far) * HEAD, ((y - fromY) / far) * HEAD];
  return `M${x} ${y}L${x - dx - dy / 2} ${y - dy + dx / 2}M${x} ${y}L${x - dx + dy / 2} ${y - dy - dx / 2}`;
}

// Returns the nearest place at or below [x, y] where a text covers none of the rectangles in `taken`. The text's
// rectangle is added to `taken`.
function freePlace([x, y], text, taken) {
  const wide = TEXT_WIDTH * text.length, free = (top) => taken.every(([left, t, right, bottom]) => x >= right || x + wide <= left || top >= bottom || top + TEXT_HEIGHT <= t);
  let top = y - TEXT_HEIGHT;
  for (let step = 0; step < MOST_STEPS && !free(top); step++) top += TEXT_HEIGHT;
  if (text !== "") taken.push([x, top, x + wide, top + TEXT_HEIGHT]);
  return [x, top + TEXT_HEIGHT];
}

// Makes the elements that draw a mark. places: the mark's points on the screen. taken: the rectangles of texts, [left, top,
// right, bottom].
function drawn(mark, places, caption, className, taken) {
  const path = places.map(([x, y], n) => `${n > 0 ? "L" : "M"}${x} ${y}`).join("") + (mark.kind === "arrow" && places.length === 2 ? head(...places) : "");
  const at = mark.kind === "ruler" && places.length === 2 ? [(places[0][0] + places[1][0]) / 2, (places[0][1] + places[1][1]) / 2]
    : mark.kind === "angle" && places.length > 1 ? places[1] : places.at(mark.kind === "arrow" ? 0 : -1);
  // A ruler's text stands to the right of the ruler's middle: above the line if the ruler falls to the right, below the line if the ruler
  // rises. The text then covers neither the line nor its ends.
  const rises = mark.kind === "ruler" && places.length === 2 && (places[1][0] - places[0][0]) * (places[1][1] - places[0][1]) < 0;
  const [x, y] = freePlace([at[0] + 8, rises ? at[1] + 8 + TEXT_HEIGHT : at[1] - 8], caption, taken);
  return [make("svg:path", { d: path, class: "mark-halo" }), make("svg:path", { d: path, class: className }), make("svg:text", { x, y, class: "mark-text" }, caption)];
}

export class Marks {
  #viewer;
  #picture;
  #planes = new Map(); // the elements and handles of marks, by slice view

  constructor(viewer) {
    this.#viewer = viewer;
    this.#picture = this.#makeLayer(viewer.find("overlay"));
  }

  #makeLayer(parent) {
    const shapes = make("svg:g", { "aria-hidden": "true" }), handles = new PictureHandles("mark-handle");
    parent.append(shapes, handles.element);
    return { shapes, handles };
  }

  // All marks, with the mark that is being made.
  get #all() {
    const { store, marking } = this.#viewer;
    return [...store.marks, ...(marking?.unfinished ? [marking.unfinished] : [])];
  }

  #draw({ shapes, handles }, project, ways, width, height, faintness) {
    const taken = [], inside = ([x, y]) => x >= 0 && y >= 0 && x <= width && y <= height, points = [];
    const made = this.#all.flatMap((mark, m) => {
      const places = mark.points.map(project), style = faintness(mark);
      if (places.length === 0 || places.includes(null) || style === null) return [];
      if (m < this.#viewer.store.marks.length)
        mark.points.forEach((point, n) => { if (inside(places[n])) points.push(this.#handle(m, n, mark, point, ways)); });
      if (m < this.#viewer.store.marks.length) return drawn(mark, places, captionOf(mark, this.#viewer), `mark ${style}`, taken);
      // A mark that is being made has dots at its points. While the mark has only one point, no
      // length is shown.
      return [...drawn(mark, places, places.length > 1 ? captionOf(mark, this.#viewer) : mark.text ?? "", `mark ${style}`, taken),
        ...places.map(([x, y]) => make("svg:circle", { cx: x, cy: y, r: DOT, class: "mark-dot" }))];
    }), isText = (one) => one.localName === "text";
    shapes.replaceChildren(...made.filter((one) => !isText(one)), ...made.filter(isText)); // no line covers a text
    handles.draw(points, project, points[0]?.at ?? [0, 0, 0], width, height);
  }

  // ways: the screen's two directions as vectors of the scene, with the length of KEY_REACH.
  #handle(m, n, mark, point, ways) {
    const { store } = this.#viewer;
    return {
      label: `${KINDS[mark.kind].name} ${m + 1}, point ${n + 1}`, kind: mark.kind, at: point,
      ways: ways.map((way) => ({ to: add(point, way), size: 1, low: 0, high: 1, now: 0 })),
      move: (steps) => {
        const moved = steps.reduce((sum, part, k) => add(sum, scale(ways[k], part)), point);
        store.setMarks(`point ${m} ${n}`, store.marks.map((one, k) => (k === m ? { ...one, points: one.points.map((p, j) => (j === n ? moved : p)) } : one)));
      },
    };
  }

  drawPicture() {
    const { store, find } = this.#viewer, svg = find("overlay"), width = svg.clientWidth, height = svg.clientHeight;
    if (height === 0) return;
    const { right, up } = axes(store.scene.camera), reach = KEY_REACH * worldHeight(store.scene.camera);
    this.#draw(this.#picture, projector(store.scene.camera, width, height), [scale(right, reach), scale(up, reach)], width, height, () => "");
  }

  // Draws the marks that lie in the plane, and, fainter, the marks that only cross the plane.
  drawPlane(view) {
    if (!this.#planes.has(view)) this.#planes.set(view, this.#makeLayer(view.marks));
    const { clientWidth: width, clientHeight: height } = view.area, project = (point) => view.project(point);
    const unit = view.directions(), within = view.halfDepth;
    this.#draw(this.#planes.get(view), project, unit.map((way) => scale(way, KEY_REACH)), width, height, (mark) => {
      const layers = mark.points.map((point) => project(point)?.[2] ?? Infinity), on = layers.filter((layer) => Math.abs(layer) <= within);
      const crosses = Math.min(...layers) < 0 && Math.max(...layers) > 0;
      return on.length === layers.length ? "" : on.length > 0 || crosses ? "faint" : null;
    });
  }
}

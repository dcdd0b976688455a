// The handles and the outline of the chosen cut. A handle moves a plane along the plane's direction. A box
// has handles at its faces. A sphere has handles at its middle and at its rim.

import { corners, edges, middle, placed } from "./boxes.js";
import { make } from "./controls.js";
import { PictureHandles } from "./picture_handles.js";
import { add, cross, dot, normalize, scale, subtract } from "./vector.js";

const AXES = [0, 1, 2];
const unit = (axis) => AXES.map((k) => (k === axis ? 1 : 0));
const sizeOf = ({ min, max }) => Math.max(...AXES.map((k) => max[k] - min[k]));

// Makes the handles of a box's six faces. whole: the box from whose size the least distance of two faces
// follows. bounds: the box within which faces may lie; null: faces may lie anywhere. place(point): maps a
// point to the scene. take(box, axis): takes the changed box.
export function faceHandles({ box, whole, bounds, place, take, label }) {
  return AXES.flatMap((axis) => ["min", "max"].map((end) => {
    const gap = (whole.max[axis] - whole.min[axis]) / 200, [low, high] = bounds ? [bounds.min[axis], bounds.max[axis]] : [-Infinity, Infinity];
    const at = AXES.map((k) => (k === axis ? box[end][k] : (box.min[k] + box.max[k]) / 2));
    const move = ([step]) => {
      const made = { min: [...box.min], max: [...box.max] }, value = box[end][axis] + step;
      made[end][axis] = end === "min" ? Math.min(Math.max(value, low), box.max[axis] - gap) : Math.max(Math.min(value, high), box.min[axis] + gap);
      take(made, axis);
    };
    const way = { to: place(add(at, scale(unit(axis), 2 * gap))), size: 2 * gap, low: whole.min[axis], high: whole.max[axis], now: box[end][axis] };
    return { label: label("xyz"[axis], end === "min" ? "least" : "greatest"), kind: `axis-${axis}`, at: place(at), ways: [way], move };
  }));
}

function planeHandle({ cut, box, place, take, noun }) {
  const normal = normalize(cut.normal), centre = middle(box), size = sizeOf(box);
  const height = dot(subtract(cut.point, centre), normal), at = add(centre, scale(normal, height));
  const move = ([step]) => take({ ...cut, point: add(cut.point, scale(normal, step)) });
  const way = { to: place(add(at, scale(normal, size / 100))), size: size / 100, low: -size / 2, high: size / 2, now: height };
  return [{ label: `Plane of the ${noun}, in the picture`, kind: "plane", at: place(at), ways: [way], move }];
}

// The handle of a sphere's rim lies on the axis that is longest in the picture. The handle of the middle
// moves along the two axes that are longest in the picture.
function sphereHandles({ cut, box, place, take, noun, project }) {
  const { center, radius } = cut, here = project(place(center)), size = sizeOf(box);
  const seen = (axis) => {
    const there = project(place(add(center, scale(unit(axis), radius))));
    return here && there ? Math.hypot(there[0] - here[0], there[1] - here[1]) : 0;
  };
  const [first, second] = [...AXES].sort((a, b) => seen(b) - seen(a));
  const way = (axis) => ({ to: place(add(center, scale(unit(axis), size / 100))), size: size / 100, low: box.min[axis], high: box.max[axis], now: center[axis] });
  const rim = add(center, scale(unit(first), radius)), wider = add(rim, scale(unit(first), size / 100));
  return [
    {
      label: `Middle of the ${noun}, in the picture`, kind: "plane", at: place(center), ways: [way(first), way(second)],
      move: ([a, b]) => take({ ...cut, center: add(center, add(scale(unit(first), a), scale(unit(second), b))) }),
    },
    {
      label: `Radius of the ${noun}, in the picture`, kind: `axis-${first}`, at: place(rim), ways: [{ to: place(wider), size: size / 100, low: 0, high: size, now: radius }],
      move: ([step]) => take({ ...cut, radius: Math.max(radius + step, size / 200) }),
    },
  ];
}

const HANDLES = {
  plane: planeHandle, sphere: sphereHandles,
  box: ({ cut, box, place, take, noun }) => faceHandles({
    box: cut, whole: box, bounds: null, place, take: (made) => take({ ...cut, ...made }), label: (axis, end) => `Box of the ${noun} ${axis}, ${end}, in the picture`,
  }),
};

// Returns the polygon in which a plane crosses a box, as corners in their order around the
// polygon's middle.
export function section({ point, normal }, box) {
  const all = corners(box), heights = all.map((corner) => dot(subtract(corner, point), normal));
  const found = edges.filter(([a, b]) => heights[a] < 0 !== heights[b] < 0)
    .map(([a, b]) => add(all[a], scale(subtract(all[b], all[a]), heights[a] / (heights[a] - heights[b]))));
  if (found.length < 3) return [];
  const centre = scale(found.reduce(add), 1 / found.length), right = normalize(subtract(found[0], centre)), up = cross(normalize(normal), right);
  const angle = (corner) => Math.atan2(dot(subtract(corner, centre), up), dot(subtract(corner, centre), right));
  return found.sort((a, b) => angle(a) - angle(b));
}

const circle = (center, radius, axis) => Array.from({ length: 48 }, (_, n) => {
  const angle = (n * Math.PI) / 24, [a, b] = [unit((axis + 1) % 3), unit((axis + 2) % 3)];
  return add(center, add(scale(a, radius * Math.cos(angle)), scale(b, radius * Math.sin(angle))));
});

// Returns the outline of a cut, as lists of points that lines connect.
function outline(cut, box) {
  if (cut.type === "plane") return [section(cut, box)];
  if (cut.type === "sphere") return AXES.map((axis) => circle(cut.center, cut.radius, axis));
  return edges.map((edge) => edge.map((n) => corners(cut)[n]));
}

// source: the owner of the cut that is shown, from cut_panel.js: { cut(), take(cut), box(), transform(),
// noun }. cut() returns null if no cut is shown.
export class CutHandles extends PictureHandles {
  #source;
  path = make("svg:path", { class: "clip-box", "aria-hidden": "true" });

  constructor(source) {
    super("cut-handle");
    this.#source = source;
  }

  drawCut(project, width, height) {
    const { noun, take } = this.#source, cut = this.#source.cut();
    this.path.setAttribute("d", "");
    if (cut === null) return this.draw([], project, [0, 0, 0], width, height);
    const box = this.#source.box(), transform = cut.world ? {} : this.#source.transform(), place = (point) => placed(point, transform);
    const lines = outline(cut, box).map((line) => line.map((point) => project(place(point)))).filter((line) => line.length > 0 && !line.includes(null));
    this.path.setAttribute("d", lines.map((line) => `M${line.join("L")}${line.length > 2 ? "Z" : ""}`).join(""));
    return this.draw(HANDLES[cut.type]({ cut, box, place, take, noun, project }), project, place(middle(box)), width, height);
  }
}

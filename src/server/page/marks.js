// Marks that stand in the scene: rulers, angles, lines of several pieces, arrows and texts. A mark is { kind,
// points, text }. points: [[x, y, z], ...] in world coordinates. The measured length or angle of a mark
// follows from its points.

import { unplaced } from "./boxes.js";
import { shortNumber } from "./controls.js";
import { lengthUnit } from "./units.js";
import { dot, length, subtract } from "./vector.js";

// The kinds of marks: the name of each kind, and the least and the greatest number of points.
export const KINDS = {
  ruler: { name: "Ruler", least: 2, most: 2 }, angle: { name: "Angle", least: 3, most: 3 }, line: { name: "Line", least: 2, most: 500 },
  arrow: { name: "Arrow", least: 2, most: 2 }, text: { name: "Text", least: 1, most: 1 },
};

// Returns the angle at b between the directions to a and to c, in degrees.
function angleOf([a, b, c]) {
  const [u, v] = [subtract(a, b), subtract(c, b)], size = length(u) * length(v);
  return size > 0 ? (180 / Math.PI) * Math.acos(Math.min(Math.max(dot(u, v) / size, -1), 1)) : 0;
}

// Returns the number that a mark measures: an angle in degrees, or a length in the units of the
// first volume's file. Null: the mark measures nothing.
export function measured(mark, viewer) {
  const points = mark.points.map((point) => unplaced(point, viewer.store.scene.volumes[0]?.transform));
  if (mark.kind === "angle") return points.length === 3 ? angleOf(points) : null;
  if (mark.kind !== "ruler" && mark.kind !== "line") return null;
  return points.slice(1).reduce((sum, point, n) => sum + length(subtract(point, points[n])), 0);
}

// Returns the text that is written at a mark. Saved pictures show the same text
// (src/figure/marks.c).
export function captionOf(mark, viewer) {
  const number = measured(mark, viewer), unit = lengthUnit(viewer);
  const said = number === null ? "" : mark.kind === "angle" ? `${number.toFixed(1)}°` : `${shortNumber(number)}${unit ? ` ${unit}` : ""}`;
  return [mark.text, said].filter(Boolean).join(": ");
}

// Returns whether an object from a file is a mark.
export const isMark = (mark) => mark?.kind in KINDS && Array.isArray(mark.points) && mark.points.length >= KINDS[mark.kind].least &&
  mark.points.length <= KINDS[mark.kind].most && typeof (mark.text ?? "") === "string" &&
  mark.points.every((point) => Array.isArray(point) && point.length === 3 && point.every(Number.isFinite));

// Returns the valid marks of a list from a file. A mark without a text gets an empty text.
export const readMarks = (list) => (Array.isArray(list) ? list.filter(isMark).map(({ kind, points, text = "" }) => ({ kind, points, text })) : []);

// The choice among several DICOM series of one folder, when a volume was read from such a folder.

import { select } from "./controls.js";

const nameOf = ({ modality, description, dimensions }) => [modality, description && `“${description}”`, dimensions.join(" × ")].filter(Boolean).join(" ");

const several = ({ series = [] }) => (series.length > 1 ? series : []);

// Returns a line that names the series of a volume, if the volume's folder has other series; else
// "". about: the volume's entry in start.json.
export function seriesOf(about) {
  const all = several(about), shown = all.find(({ chosen }) => chosen);
  return shown ? `${nameOf(shown)} is shown, one of ${all.length} series` : "";
}

// Makes a list that opens another series in place of the open series. Returns [the list's row], or [] if there is no other series to
// choose. file: the folder's whole path.
export function seriesRow(viewer, about, file) {
  const { start, channel } = viewer, all = several(about), isAlone = start.volumes.length === 1 && !start.scene.meshes?.length;
  if (all.length === 0 || !isAlone || !channel.open || !file?.startsWith("/")) return [];
  const shown = all.find(({ chosen }) => chosen)?.choice;
  const choice = select({ label: "Series", choices: all.map((one) => [one.choice, nameOf(one)]), get: () => shown, set: (series) => viewer.openSeries(file, series), title: "Opens another series of this folder" });
  choice.update();
  return [choice.element];
}

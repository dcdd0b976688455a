// Several DICOM series in one folder, of which a volume is one.

import { select } from "./controls.js";

const nameOf = ({ modality, description, dimensions }) => [modality, description && `“${description}”`, dimensions.join(" × ")].filter(Boolean).join(" ");

const several = ({ series = [] }) => (series.length > 1 ? series : []);

// Which series a volume (of start.json) is, where its folder has others: a line, else "".
export function seriesOf(about) {
  const all = several(about), shown = all.find(({ chosen }) => chosen);
  return shown ? `${nameOf(shown)} is shown, one of ${all.length} series` : "";
}

// A list that opens another series in place of the one that is open: [its row], or [] where there is none to choose. file: the folder's
// whole path.
export function seriesRow(viewer, about, file) {
  const { start, channel } = viewer, all = several(about), isAlone = start.volumes.length === 1 && !start.scene.meshes?.length;
  if (all.length === 0 || !isAlone || !channel.open || !file?.startsWith("/")) return [];
  const shown = all.find(({ chosen }) => chosen)?.choice;
  const choice = select({ label: "Series", choices: all.map((one) => [one.choice, nameOf(one)]), get: () => shown, set: (series) => viewer.openSeries(file, series), title: "Opens another series of this folder" });
  choice.update();
  return [choice.element];
}

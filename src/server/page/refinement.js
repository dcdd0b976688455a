// Volumes of several resolutions are read from coarse to fine. While finer resolutions are still to be read, the page asks the server for
// the progress. Each time a finer resolution has been read, the page updates the volumes of start.json and makes the picture anew.

import { Lost } from "./connection.js";

const ASK_EVERY = 250; // milliseconds

// Returns a line that says how many chunks of a volume's store are absent from the store's server; "": none.
// volume: the volume's entry in start.json.
export function absenceOf(volume) {
  const [absent = 0, chunks = 0] = volume?.absent_chunks ?? [];
  return absent > 0 ? `the server has no file for ${absent} of ${chunks} chunks: their voxels have the fill value` : "";
}

// Returns the absenceOf() lines of all volumes, each with the volume's name.
export const absenceIn = ({ volumes, scene }) => volumes.map((volume, v) => [absenceOf(volume), (scene.volumes?.[v]?.file ?? "").split("/").pop()])
  .filter(([line]) => line !== "").map(([line, name]) => `${name}: ${line}`).join("; ");

// The line about the resolution of the picture. of(text): sets the line about the open voxels. seen(frame): takes a frame of frames.js; while
// its picture is shown, the line about the picture's finer voxels replaces the line about the open voxels. warn(text) and failed(error) are
// called once for each new line.
export function resolutionLine(element, { warn, failed }) {
  let open = "", finer = "", told = "";
  const show = () => { element.textContent = element.title = finer || open; };

  function seen({ stage, seen: read }) {
    if (stage !== "final" && stage !== "moving") return;
    const problem = read?.problem ?? "";
    finer = problem ? `a coarser resolution is shown: ${problem}` : (read?.volumes ?? []).map(absenceOf).filter(Boolean).join("; ");
    show();
    if (stage !== "final") return;
    if (finer !== "" && finer !== told) problem ? failed(new Error(problem)) : warn(finer);
    told = finer;
  }
  return { seen, of: (text) => { open = text; show(); } };
}

// whole: start.json, whose volumes the viewer's panels have; its entries are changed in place. tell(text): shows a line about the
// resolution of the picture; "": the picture has the resolution that it shall have. warn(text): called once for each line about voxels
// that a server lacks. renew(): called when the volumes have changed. Returns end().
export function followRefinement(whole, channel, { tell, warn, renew, failed }) {
  let timer = 0, ended = false, warned = "";

  // Tells which chunks the server lacks, after everything was read.
  function tellAbsence() {
    const line = absenceIn(whole);
    tell(line);
    if (line !== "" && line !== warned) warn(line);
    warned = line;
  }

  async function take() {
    const fresh = await channel.start();
    if (ended) return;
    whole.volumes.forEach((volume, v) => { if (volume && fresh.volumes[v]) Object.assign(volume, fresh.volumes[v]); });
    [whole.refined, whole.refining] = [fresh.refined, fresh.refining];
    renew();
  }

  async function ask() {
    try {
      const { refined, refining, problem } = await channel.refinement();
      if (ended) return;
      if (refined !== whole.refined) await take();
      if (ended) return;
      whole.refining = refining;
      if (problem) tell(`a coarser resolution is shown: ${problem}`);
      else if (refining) tell("finer voxels are being read");
      else tellAbsence();
      if (problem) failed(new Error(problem));
    } catch (error) {
      if (!(error instanceof Lost)) return failed(error);
    }
    if (whole.refining && !ended) timer = setTimeout(ask, ASK_EVERY);
    return undefined;
  }

  if (whole.refining && channel.refinement) ask();
  else tellAbsence();
  return () => {
    ended = true;
    clearTimeout(timer);
  };
}

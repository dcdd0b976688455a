// Volumes of several resolutions are read from coarse to fine. While finer ones are still to be read, the page asks how far that is; each
// time one is there, the volumes of start.json are brought up to date, and the picture is made anew.

import { Lost } from "./connection.js";

const ASK_EVERY = 250; // milliseconds

// whole: start.json, whose volumes the viewer's panels have; its entries are changed in place. tell(text): shows what the picture is
// of, "" for the voxels that it shall be of. renew(): called when the volumes have changed. Returns end().
export function followRefinement(whole, channel, { tell, renew, failed }) {
  let timer = 0, ended = false;

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
      tell(problem ? `a coarser resolution is shown: ${problem}` : refining ? "finer voxels are being read" : "");
      if (problem) failed(new Error(problem));
    } catch (error) {
      if (!(error instanceof Lost)) return failed(error);
    }
    if (whole.refining && !ended) timer = setTimeout(ask, ASK_EVERY);
    return undefined;
  }

  if (whole.refining && channel.refinement) ask();
  return () => {
    ended = true;
    clearTimeout(timer);
  };
}

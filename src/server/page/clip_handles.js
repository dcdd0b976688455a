// Handles of the clip box. Each of the box's six faces has a handle in its middle, which is dragged along
// the face's axis.

import { middle, placed, worldBox } from "./boxes.js";
import { faceHandles } from "./cut_handles.js";
import { PictureHandles } from "./picture_handles.js";

export class ClipHandles extends PictureHandles {
  #viewer;

  constructor(viewer) {
    super("clip-handle");
    this.#viewer = viewer;
  }

  drawClip(shown, project, width, height) {
    const { store, start, current } = this.#viewer, volume = store.scene.volumes[current.volume];
    if (!shown) return this.draw([], project, [0, 0, 0], width, height);
    const whole = worldBox(start.volumes[current.volume]), box = volume.clip ?? whole, place = (point) => placed(point, volume.transform);
    const take = (clip, axis) => store.changeVolume(current.volume, `clip ${axis}`, (v) => ({ ...v, clip }));
    const handles = faceHandles({ box, whole, bounds: whole, place, take, label: (axis, end) => `Clip ${axis}, ${end}, in the picture` });
    return this.draw(handles, project, place(middle(box)), width, height);
  }
}

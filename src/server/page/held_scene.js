// The scene of which the other end of a channel holds a copy. While something moves, a frame sends only the differences from
// this scene.

import { difference } from "./link.js";

export class HeldScene {
  #held = null; // { number, scene }: the newest scene that was sent as a whole, and the number of its frame; null: the other end may not hold a scene
  #newest = 0; // the number of the newest frame that was sent with a whole scene; the frame may not have arrived yet
  #next;

  // next(): returns the number of a new frame.
  constructor(next) {
    this.#next = next;
  }

  // Forgets the held scene, because the other end may have been replaced.
  forget() {
    this.#held = null;
  }

  // Requests a frame. With `moving`, the request may carry a difference in place of the scene. ask(number, body, base) sends one
  // request. body: the text of the scene; if base is given, the text of the difference from the scene of frame `base`. If the other end
  // does not hold that scene, ask() fails with an error that has `noBase`, and the whole scene is sent.
  async send(scene, moving, ask) {
    if (moving && this.#held !== null) {
      const part = difference(this.#held.scene, JSON.parse(JSON.stringify(scene))) ?? { in: {} };
      try {
        return await ask(this.#next(), JSON.stringify(part), this.#held.number);
      } catch (error) {
        if (!error.noBase) throw error;
      }
    }
    const number = this.#next(), body = JSON.stringify(scene);
    [this.#held, this.#newest] = [null, number];
    const answer = await ask(number, body);
    if (this.#newest === number) this.#held = { number, scene: JSON.parse(body) };
    return answer;
  }
}

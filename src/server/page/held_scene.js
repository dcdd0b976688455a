// The scene of which the other end of a channel holds a copy: while something moves, a frame sends only what differs from it.

import { difference } from "./link.js";

export class HeldScene {
  #held = null; // { number, scene }: the newest scene that was sent whole, and its frame; null: the other end may hold none, or not yet
  #newest = 0; // the frame of that scene, which may be under way
  #next;

  // next(): the number of a new frame.
  constructor(next) {
    this.#next = next;
  }

  // The other end may have ended since.
  forget() {
    this.#held = null;
  }

  // Asks for a frame, of a difference where `moving` allows it. ask(number, body, base) asks once: body is the text of the scene, or,
  // where base is given, of what differs from the scene of frame `base`. Its error has `noBase` where the other end holds no such scene:
  // the scene is then sent whole.
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

// What is chosen for the panels: a volume, a light, an isosurface, a cut, and a cut of the scene, each as a number. The choices are kept in
// store.page, so that they are undone and come back with a session.

export const KINDS = ["volume", "light", "surface", "cut", "sceneCut"];

export class Current {
  #store;

  constructor(store) {
    this.#store = store;
  }

  // The chosen one of `count` things of a kind; the last one where there are fewer.
  of(kind, count) {
    const index = this.#store.page[kind];
    return Number.isInteger(index) && index >= 0 ? Math.min(index, Math.max(count - 1, 0)) : 0;
  }

  choose(kind, index) {
    this.#store.setPage({ [kind]: index });
  }

  get volume() { return this.of("volume", this.#store.scene.volumes.length); }
  get light() { return this.of("light", this.#store.scene.lights.length); }
}

// The things that the panels edit at present: a volume, a light, an isosurface, a cut of a volume, and a cut of the scene, each given by
// its index. The indices are kept in store.page, so that undo and sessions restore them.

export const KINDS = ["volume", "light", "surface", "cut", "sceneCut"];

export class Current {
  #store;

  constructor(store) {
    this.#store = store;
  }

  // Returns the index of the chosen thing of a kind, at most count - 1.
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

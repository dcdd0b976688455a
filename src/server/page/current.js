// The volume and the light that are chosen for the panels, as numbers. The choices are kept in store.page, so that they are undone and
// come back with a session; a scene of fewer volumes or lights has its last one chosen.

export class Current {
  #store;

  constructor(store) {
    this.#store = store;
  }

  #chosen(key, count) {
    const index = this.#store.page[key];
    return Number.isInteger(index) && index >= 0 ? Math.min(index, Math.max(count - 1, 0)) : 0;
  }

  get volume() { return this.#chosen("volume", this.#store.scene.volumes.length); }
  set volume(volume) { this.#store.setPage({ volume }); }
  get light() { return this.#chosen("light", this.#store.scene.lights.length); }
  set light(light) { this.#store.setPage({ light }); }
}

// Where a gesture begins and ends. It lasts from the first pointer or key that goes down to the last one that
// comes up. Everything that changes in between is one step of the history.

// root: the viewer's element.
export function followGestures(root, store, signal) {
  const down = new Set(), ending = new Set(), listen = (target, names, action) => names.forEach((name) => target.addEventListener(name, action, { capture: true, signal }));
  const end = () => {
    if (ending.size === 0) return;
    ending.forEach((key) => down.delete(key));
    ending.clear();
    if (down.size === 0) store.endGesture();
  };
  const begin = (key) => {
    end();
    if (down.size === 0) store.beginGesture();
    down.add(key);
  };
  // Changes by listeners of the event's target belong to the gesture: it ends after them, or when the next
  // gesture begins.
  const endSoon = (key) => {
    if (!down.has(key)) return;
    ending.add(key);
    setTimeout(end, 0);
  };
  listen(root, ["pointerdown"], (event) => begin(`pointer ${event.pointerId}`));
  listen(window, ["pointerup", "pointercancel"], (event) => endSoon(`pointer ${event.pointerId}`));
  listen(root, ["click"], () => { begin("click"); endSoon("click"); });
  listen(root, ["keydown"], (event) => begin(`key ${event.code || event.key}`));
  listen(window, ["keyup"], (event) => endSoon(`key ${event.code || event.key}`));
  // A field is left, or a colour picker is closed.
  listen(root, ["change"], () => { begin("change"); endSoon("change"); });
  // The window loses the focus. An element that loses it, as a key of the timeline that is drawn anew, ends nothing.
  listen(window, ["blur"], (event) => {
    if (event.target !== window) return;
    down.clear();
    ending.clear();
    store.endGesture();
  });
}

// Finds where gestures begin and end. A gesture lasts from the press of the first pointer or key to the
// release of the last one. All changes during a gesture are one step of the history.

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
  // Changes by other listeners of the same event belong to the gesture. The gesture therefore ends after
  // these listeners have run, or when the next gesture begins.
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
  // The event `change` comes when a field is left or a colour picker is closed.
  listen(root, ["change"], () => { begin("change"); endSoon("change"); });
  // All gestures end when the window loses the focus. The loss of an element's focus ends no gesture, because
  // elements such as the timeline's keys are drawn anew during a gesture.
  listen(window, ["blur"], (event) => {
    if (event.target !== window) return;
    down.clear();
    ending.clear();
    store.endGesture();
  });
}

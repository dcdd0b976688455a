// Drags by a mouse, a pen or a finger. A drag follows one pointer from its press to its release, so that a second finger
// does not move what the first finger holds.

const FINGER = 2; // a finger takes hold of things within this many times the distance of a mouse

// Calls move(event) for each movement of the pointer of `event`, which has just gone down. target: the element that receives
// the pointer's events during the drag. The target is the window if the element under the pointer is replaced during the
// drag.
export function followDrag(event, target, move) {
  const lifted = new AbortController(), { signal } = lifted, isSame = (later) => later.pointerId === event.pointerId;
  target.setPointerCapture?.(event.pointerId);
  target.addEventListener("pointermove", (moved) => { if (isSame(moved)) move(moved); }, { signal });
  for (const over of ["pointerup", "pointercancel"])
    target.addEventListener(over, (last) => { if (isSame(last)) lifted.abort(); }, { signal });
}

// Returns the distance, in pixels, within which a pointer takes hold of a small thing. pixels: this
// distance for a mouse.
export const reachOf = (event, pixels) => (event.pointerType === "touch" ? FINGER * pixels : pixels);

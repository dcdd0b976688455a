// Drags by a mouse, a pen or a finger. A drag follows one pointer from where it goes down to where it is lifted: a second
// finger does not move what the first one holds.

const FINGER = 2; // a finger reaches this many times as far as the point of a mouse

// Calls move(event) for each movement of the pointer of `event`, which has just gone down. target: the element that gets the
// pointer's events until then, or the window, which gets them where the element under the pointer is drawn anew meanwhile.
export function followDrag(event, target, move) {
  const lifted = new AbortController(), { signal } = lifted, isSame = (later) => later.pointerId === event.pointerId;
  target.setPointerCapture?.(event.pointerId);
  target.addEventListener("pointermove", (moved) => { if (isSame(moved)) move(moved); }, { signal });
  for (const over of ["pointerup", "pointercancel"])
    target.addEventListener(over, (last) => { if (isSame(last)) lifted.abort(); }, { signal });
}

// The pixels from a small thing within which a pointer takes hold of it. pixels: for a mouse.
export const reachOf = (event, pixels) => (event.pointerType === "touch" ? FINGER * pixels : pixels);

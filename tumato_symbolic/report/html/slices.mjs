// Work that takes long, done a little at a time, so that the page can be used meanwhile.
// Milliseconds of work before the page is served.
const SLICE = 14;
// Milliseconds after which what was found by then is drawn.
const BETWEEN = 250;

// `draw` shows now and then how far the generator `work` has come, and at the end; then comes `finished`.
export function inSlices(work, draw, finished) {
  let drawn = 0;
  const go = () => {
    const until = performance.now() + SLICE;
    let over = false;
    while (!over && performance.now() < until) over = work.next().done;
    if (over || until > drawn + BETWEEN) {
      drawn = until;
      draw();
    }
    if (over) finished();
    else setTimeout(go, 0);
  };
  setTimeout(go, 50);
}

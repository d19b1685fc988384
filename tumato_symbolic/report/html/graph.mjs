// The graph of decisions: what follows what, along nominal runs.
import { h, redraw, svg } from "./dom.mjs";
import { upTo } from "./spec.mjs";
import { actionsText, counted, grouped } from "./words.mjs";

// So many decisions are drawn; of more, those near the chosen one.
const MOST_BOXES = 20;
// So many boxes stand below each other.
const MOST_BELOW = 7;
// The width of a box.
const WIDTH = 180;
// The height of a line in it.
const LINE = 17;
const GAP = { across: 64, down: 18 };

export function graphView(app) {
  const element = h("div");
  const update = () => {
    const chosen = app.model.decide(app.selected);
    const { nodes, edges } = app.decisions;
    if (chosen === null || !nodes.has(chosen.join())) {
      return redraw(element, h("p", "The chosen state is not decided, or its decision was not met yet."));
    }
    const selected = chosen.join();
    const { columns, left } = placed(app, selected);
    const said = nodes.size <= MOST_BOXES ? `All ${nodes.size} decisions` : `The neighbourhood of the decision for the chosen state, out of ${nodes.size} decisions`;
    return redraw(element,
      h("p.quiet", `${said}, with what follows them if effects are as intended. `,
        app.found.done ? "" : "More may come: states are still being looked at. ",
        left ? `${counted(left, "more neighbour")} ${left > 1 ? "are" : "is"} left out. ` : "", "A box can be chosen."),
      h("div", { class: "wide graph" }, picture(app, columns, edges, selected)));
  };
  return { element, update };
}

// Boxes in columns: what comes before the selection, the selection, what comes after it, and the others.
function placed(app, selected) {
  const { nodes, edges } = app.decisions;
  const after = [];
  const before = [];
  for (const [edge, count] of [...edges].sort((one, other) => other[1] - one[1])) {
    const [from, to] = edge.split(">");
    if (from === to || count === 0) continue;
    if (from === selected && !after.includes(to)) after.push(to);
    if (to === selected && !before.includes(from)) before.push(from);
  }
  const earlier = before.filter((name) => !after.includes(name));
  const all = nodes.size <= MOST_BOXES;
  const room = all ? MOST_BOXES : MOST_BOXES - 1;
  const right = after.slice(0, all ? room : Math.max(room - earlier.length, Math.ceil(room / 2)));
  const leftSide = earlier.slice(0, room - right.length);
  const shown = new Set([selected, ...right, ...leftSide]);
  const others = all ? [...nodes.keys()].filter((name) => !shown.has(name)) : [];
  const columns = [leftSide, [selected], right, others].flatMap(inColumns);
  return { columns, left: after.length + earlier.length - right.length - leftSide.length };
}

// Columns that are not too high.
function inColumns(names) {
  const number = Math.ceil(names.length / MOST_BELOW);
  const high = Math.ceil(names.length / number);
  return upTo(number).map((n) => names.slice(n * high, (n + 1) * high));
}

function linesOf(app, name) {
  const words = actionsText(app.spec, app.decisions.nodes.get(name).chosen).split(", ");
  const lines = words.slice(0, 5).map((word) => (word.length > 24 ? `${word.slice(0, 23)}…` : word));
  return words.length > 5 ? [...lines, `and ${words.length - 5} more`] : lines;
}

function picture(app, columns, edges, selected) {
  const boxes = new Map();
  const heights = columns.map((column) => column.reduce((all, name) => all + boxHeight(app, name) + GAP.down, 0));
  const height = Math.max(...heights) + 20;
  columns.forEach((column, n) => {
    let y = (height - heights[n] + GAP.down) / 2;
    for (const name of column) {
      boxes.set(name, { x: 10 + n * (WIDTH + GAP.across), y, height: boxHeight(app, name) });
      y += boxHeight(app, name) + GAP.down;
    }
  });
  const width = columns.length * (WIDTH + GAP.across) + 20;
  const arrows = [...edges].flatMap(([edge, count]) => {
    const [from, to] = edge.split(">");
    return from !== to && boxes.has(from) && boxes.has(to) ? [arrow(boxes.get(from), boxes.get(to), count, from === selected || to === selected)] : [];
  });
  arrows.sort((one, other) => one.near - other.near);
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "group", "aria-label": "graph of decisions" },
    svg("defs", {}, svg("marker", { id: "head", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto" }, svg("path", { d: "M0 0 8 4 0 8z" }))),
    arrows.map((each) => each.drawn), [...boxes].map(([name, box]) => drawnBox(app, name, box, name === selected)));
}

const boxHeight = (app, name) => (linesOf(app, name).length + 1) * LINE + 12;

function drawnBox(app, name, box, selected) {
  const node = app.decisions.nodes.get(name);
  const choose = () => app.select(node.example);
  const label = `${actionsText(app.spec, node.chosen)}: ${counted(node.count, "state")}`;
  const lines = [...linesOf(app, name), `${grouped(node.count)} ${node.count === 1 ? "state" : "states"}`];
  return svg("g", { class: selected ? "box selected" : "box", tabindex: 0, role: "button", "aria-label": label, key: `b${name}`, onclick: choose,
    onkeydown: (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(); } } },
  svg("rect", { x: box.x, y: box.y, width: WIDTH, height: box.height, rx: 6 }),
  lines.map((line, n) => svg("text", { x: box.x + WIDTH / 2, y: box.y + 18 + n * LINE, class: n === lines.length - 1 ? "count" : "do" }, line)));
}

function arrow(from, to, count, near) {
  const down = (box) => box.y + box.height / 2;
  let path;
  if (from.x === to.x) {
    const x = from.x + WIDTH;
    path = `M${x} ${down(from)} C${x + 50} ${down(from)} ${x + 50} ${down(to)} ${x} ${down(to)}`;
  } else {
    const forward = from.x < to.x;
    const [x, end] = forward ? [from.x + WIDTH, to.x] : [from.x, to.x + WIDTH];
    const shift = forward ? 5 : -5;
    const bend = (end - x) / 2;
    path = `M${x} ${down(from) + shift} C${x + bend} ${down(from) + shift} ${end - bend} ${down(to) + shift} ${end} ${down(to) + shift}`;
  }
  return { near, drawn: svg("path", { d: path, class: near ? "edge" : "edge dim", "marker-end": "url(#head)" }, svg("title", {}, counted(count, "state"))) };
}

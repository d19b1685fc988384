// What is decided where: decision diagrams, cubes of states, and policy files that the reader opens.
import { upTo } from "./spec.mjs";

// Reference r is a leaf below 2 (0 is false, 1 is true), else node r - 2: [level, [reference, …]].
function follow(diagram, root, state) {
  while (root > 1) {
    const [level, below] = diagram.nodes[root - 2];
    root = below[state[diagram.order[level]]];
  }
  return root === 1;
}

// Decisions of a diagram: `at(state)` is a sorted array of action numbers, null where nothing is decided.
export function decisionsFrom(spec, diagram) {
  const known = spec.total <= 2e6 ? new Int32Array(spec.total).fill(-2) : null;
  const sets = [];
  const numbers = new Map();
  const computed = (state) => {
    if (!follow(diagram, diagram.defined, state)) return -1;
    const chosen = [];
    diagram.roots.forEach((root, number) => follow(diagram, root, state) && chosen.push(number));
    const name = chosen.join();
    if (!numbers.has(name)) {
      numbers.set(name, sets.length);
      sets.push(chosen);
    }
    return numbers.get(name);
  };
  const at = (state) => {
    if (!known) {
      const found = computed(state);
      return found < 0 ? null : sets[found];
    }
    const key = spec.key(state);
    if (known[key] === -2) known[key] = computed(state);
    return known[key] < 0 ? null : sets[known[key]];
  };
  return { at, diagram };
}

// The values that each variable may have under a filter: a Set of value numbers, null where all may.
const free = (spec, filter, n) => (filter[n] ? [...filter[n]].sort((a, b) => a - b) : upTo(spec.sizes[n]));

// Disjoint cubes of the decided states that a filter leaves, each with its decision and its number of states; those where
// an action is executed, if one is named.
export function* cubes(spec, diagram, filter, executed = null) {
  const roots = [diagram.defined, ...diagram.roots];
  const nothing = (here) => here[0] === 0 || (executed !== null && here[executed + 1] === 0);
  for (const { values, count, leaves } of cubesOf(spec, diagram, roots, filter, nothing)) {
    yield { values, count, chosen: decisionOf(leaves) };
  }
}

const decisionOf = ([defined, ...roots]) => (defined ? roots.flatMap((root, number) => (root ? [number] : [])) : null);

// Disjoint cubes in which two diagrams of one order decide otherwise, with the decisions of both.
export function* differing(spec, ours, theirs) {
  const { at, order, nodes } = together(ours, theirs);
  const [here, there] = [ours, theirs].map((each, n) => [each.defined, ...each.roots].map((root) => at[n][root]));
  const half = here.length;
  const same = (roots) => (roots[0] === 0 && roots[half] === 0) || roots.slice(0, half).join() === roots.slice(half).join();
  for (const { values, count, leaves } of cubesOf(spec, { order, nodes }, [...here, ...there], spec.names.map(() => null), same)) {
    yield { values, count, chosen: decisionOf(leaves.slice(0, half)), theirs: decisionOf(leaves.slice(half)) };
  }
}

// The nodes of two diagrams of one order, each once, and where the references of each are among them.
function together(...diagrams) {
  const nodes = [];
  const known = new Map();
  const at = diagrams.map((diagram) => {
    const found = [0, 1];
    for (const [level, below] of diagram.nodes) {
      const moved = below.map((root) => found[root]);
      const name = `${level};${moved}`;
      if (!known.has(name)) known.set(name, moved.every((root) => root === moved[0]) ? moved[0] : nodes.push([level, moved]) + 1);
      found.push(known.get(name));
    }
    return found;
  });
  return { at, order: diagrams[0].order, nodes };
}

// Disjoint cubes of the states that a filter leaves, each with where it leads from some roots, but for what is passed over.
// Large ones tend to come first: what may hold many states is looked at first.
function* cubesOf(spec, diagram, start, filter, passed) {
  const levels = diagram.order.length;
  const level = (root) => (root > 1 ? diagram.nodes[root - 2][0] : levels);
  const sizes = spec.sizes.map((_, n) => free(spec, filter, n));
  const pending = [];
  const add = (roots, fixed, count) => (pending[Math.floor(Math.log2(count))] ??= []).push([roots, fixed, count]);
  add(start, [], sizes.reduce((all, some) => all * some.length, 1));
  while (pending.length) {
    if (!pending.at(-1)?.length) {
      pending.pop();
      continue;
    }
    const [roots, fixed, count] = pending.at(-1).pop();
    if (passed(roots)) continue;
    const first = Math.min(...roots.map(level));
    if (first === levels) {
      const values = sizes.slice();
      for (const [n, some] of fixed) values[n] = some;
      yield { values, count, leaves: roots };
      continue;
    }
    const variable = diagram.order[first];
    const parts = new Map();
    for (const value of sizes[variable]) {
      const below = roots.map((root) => (level(root) === first ? diagram.nodes[root - 2][1][value] : root));
      const name = below.join();
      if (!parts.has(name)) parts.set(name, [below, []]);
      parts.get(name)[1].push(value);
    }
    for (const [below, some] of parts.values()) {
      add(below, [...fixed, [variable, some]], (count / sizes[variable].length) * some.length);
    }
  }
}

// The decided states that a filter leaves: `count` is how many, exactly, and `draw(chance)` one of them, all being
// equally likely; `chance` gives numbers from 0 to below 1.
export function decided(spec, diagram, filter) {
  const levels = diagram.order.length;
  const values = spec.sizes.map((_, n) => free(spec, filter, n));
  const width = (level) => BigInt(values[diagram.order[level]].length);
  const above = (from, to) => {
    let found = 1n;
    for (let level = from; level < to; level++) found *= width(level);
    return found;
  };
  const levelOf = (root) => (root > 1 ? diagram.nodes[root - 2][0] : levels);
  const known = new Map([[0, 0n], [1, 1n]]);
  const below = (root) => {
    if (!known.has(root)) {
      const [level, children] = diagram.nodes[root - 2];
      known.set(root, values[diagram.order[level]].reduce((all, value) => all + from(children[value], level + 1), 0n));
    }
    return known.get(root);
  };
  const from = (root, level) => below(root) * above(level, levelOf(root));
  const tested = new Set(diagram.order);
  const untested = spec.sizes.reduce((all, _, n) => (tested.has(n) ? all : all * BigInt(values[n].length)), 1n);
  const draw = (chance) => {
    const state = values.map((some) => some[Math.floor(chance() * some.length)]);
    let root = diagram.defined;
    while (root > 1) {
      const [level, children] = diagram.nodes[root - 2];
      const variable = diagram.order[level];
      let left = chance() * Number(below(root));
      for (const value of values[variable]) {
        const weight = Number(from(children[value], level + 1));
        if (!weight) continue;
        state[variable] = value;
        left -= weight;
        if (left < 0) break;
      }
      root = diagram.nodes[root - 2][1][state[variable]];
    }
    return state;
  };
  return { count: untested * from(diagram.defined, 0), draw };
}

// The same states in fewer cubes: those of one decision that differ in a single variable become one. For each variable,
// cubes are compared by a sum of numbers that stand for the values of all others, and then by these.
export function merged(found) {
  const numbers = new Map();
  const numberOf = (some) => {
    const text = some.join();
    if (!numbers.has(text)) numbers.set(text, numbers.size + 1);
    return numbers.get(text);
  };
  const share = (cube, n) => {
    const mixed = Math.imul(cube.ids[n] * 64 + n + 1, 0x9e3779b1);
    return Math.imul(mixed ^ (mixed >>> 15), 0x85ebca6b);
  };
  let list = found.map((each) => {
    const cube = { ...each, values: each.values.slice(), ids: each.values.map(numberOf) };
    return { ...cube, sum: cube.ids.reduce((all, _, n) => (all + share(cube, n)) | 0, 0) };
  });
  for (let before = Infinity; list.length < before;) {
    before = list.length;
    for (let n = 0; list.length && n < list[0].values.length; n++) {
      const together = new Map();
      const left = [];
      for (const cube of list) {
        const name = `${(cube.sum - share(cube, n)) | 0};${cube.name ?? cube.chosen}`;
        const other = together.get(name);
        if (other && cube.ids.every((id, at) => at === n || id === other.ids[at])) {
          other.sum -= share(other, n);
          other.values[n] = [...other.values[n], ...cube.values[n]].sort((a, b) => a - b);
          other.ids[n] = numberOf(other.values[n]);
          other.sum = (other.sum + share(other, n)) | 0;
          other.count += cube.count;
        } else {
          if (!other) together.set(name, cube);
          left.push(cube);
        }
      }
      list = left;
    }
  }
  return list;
}

// The decisions of a policy file, by the names of `spec`; throws an Error that says what does not fit.
export function decisionsOfFile(spec, text) {
  const file = JSON.parse(text);
  if (file.Type !== "policy" && file.Type !== "policy-diagram") throw new Error("this is no policy file");
  const numbered = (names, known, what) => names.map((name) => {
    const found = known.indexOf(name);
    if (found < 0) throw new Error(`the file has the ${what} ${name}, which this specification does not have`);
    return found;
  });
  const actions = spec.actions.map((each) => each.name);
  numbered(file.Actions, actions, "action");
  const variables = Object.keys(file.States);
  numbered(variables, spec.names, "variable");
  const values = {};
  for (const name of variables) {
    const n = spec.names.indexOf(name);
    const inOrder = Object.entries(file.States[name]).sort((one, other) => one[1] - other[1]);
    values[name] = numbered(inOrder.map(([value]) => value), spec.values[n], `value of ${name}`);
  }
  const lacking = spec.names.find((name) => !variables.includes(name));
  if (lacking) throw new Error(`the file lacks the variable ${lacking}`);
  if (file.Type === "policy-diagram") return diagramOfFile(spec, file, values);
  const rows = new Map();
  for (const row of file.Policy) {
    const state = spec.names.map((name, n) => spec.values[n].indexOf(String(row[name])));
    rows.set(spec.key(state), numbered(row.Actions, actions, "action").sort((a, b) => a - b));
  }
  return { at: (state) => rows.get(spec.key(state)) ?? null, diagram: null };
}

// Roots in the order of our actions, children in the order of our values.
function diagramOfFile(spec, file, values) {
  const { Order, Leaves, Nodes, Roots, Defined } = file.Diagram;
  const leaf = Leaves.map((each) => (each ? 1 : 0));
  const moved = (root) => (root < Leaves.length ? leaf[root] : root - Leaves.length + 2);
  const nodes = Nodes.map(([level, below]) => {
    const inOurs = new Array(spec.sizes[spec.names.indexOf(Order[level])]).fill(0);
    below.forEach((child, value) => { inOurs[values[Order[level]][value]] = moved(child); });
    return [level, inOurs];
  });
  const order = Order.map((name) => spec.names.indexOf(name));
  const roots = spec.actions.map((each) => (each.name in Roots ? moved(Roots[each.name]) : 0));
  return decisionsFrom(spec, { order, nodes, roots, defined: moved(Defined) });
}

// A text area with line numbers, marks under what is wrong, and a list of it.

const LIKELIEST = ["error", "warning", "remark"];

export class Editor {
  constructor(changed) {
    [this.area, this.marks, this.gutter, this.list] =
      ["text", "marks", "gutter", "problems"].map((id) => document.getElementById(id));
    this.problems = [];
    this.area.addEventListener("input", () => {
      this.draw([]);
      changed(this.text);
    });
    this.area.addEventListener("scroll", () => this.follow());
    new ResizeObserver(() => this.follow()).observe(this.area);
  }

  get text() {
    return this.area.value;
  }

  set text(text) {
    this.area.value = text;
    this.area.setSelectionRange(0, 0);
    this.area.scrollTop = this.area.scrollLeft = 0;
    this.show([]);
  }

  follow() {
    this.marks.scrollTop = this.gutter.scrollTop = this.area.scrollTop;
    this.marks.scrollLeft = this.area.scrollLeft;
  }

  // All problems, at their places and as a list.
  show(problems) {
    this.draw(problems);
    this.list.replaceChildren(...problems.map((problem) => this.item(problem)));
  }

  draw(problems) {
    const lines = this.text.split("\n");
    const worst = new Map();
    for (const { severity, range } of problems) {
      if (range === null) continue;
      const known = worst.get(range[0][0]);
      if (known === undefined || LIKELIEST.indexOf(severity) < LIKELIEST.indexOf(known)) worst.set(range[0][0], severity);
    }
    this.gutter.replaceChildren(...lines.map((_, line) => element("div", worst.get(line) ?? "", `${line + 1}`)));
    this.marks.replaceChildren(...marked(this.text, this.spans(lines, problems)));
    this.follow();
  }

  // From and to in the whole text, in order, none within another; an empty place is made one character wide.
  spans(lines, problems) {
    const starts = [0];
    for (const line of lines) starts.push(starts.at(-1) + line.length + 1);
    const found = problems.filter(({ range }) => range !== null).map(({ severity, range: [from, to] }) => {
      const start = starts[from[0]] + from[1];
      return { severity, start, end: Math.max(starts[to[0]] + to[1], start + 1) };
    });
    found.sort((one, other) => one.start - other.start || LIKELIEST.indexOf(one.severity) - LIKELIEST.indexOf(other.severity));
    let end = 0;
    return found.filter((each) => each.start >= end && (end = each.end));
  }

  item(problem) {
    const button = element("button", "", "");
    const place = problem.range === null ? "" : `line ${problem.range[0][0] + 1}: `;
    const more = [...problem.notes, ...(problem.help === null ? [] : [`help: ${problem.help}`])];
    button.append(element("span", "kind", `${problem.severity} ${problem.code} `), `${place}${problem.message}`);
    if (more.length) button.append(element("small", "", more.join("\n")));
    button.addEventListener("click", () => this.select(problem.range));
    const item = element("li", problem.severity, "");
    item.append(button);
    return item;
  }

  select(range) {
    if (range === null) return;
    const lines = this.text.split("\n");
    const place = ([line, column]) => lines.slice(0, line).reduce((sum, each) => sum + each.length + 1, 0) + column;
    this.area.focus();
    this.area.setSelectionRange(place(range[0]), place(range[1]));
    const height = this.area.scrollHeight / lines.length;
    this.area.scrollTop = Math.max(0, range[0][0] * height - this.area.clientHeight / 3);
  }
}

export function element(name, kind, text) {
  const made = document.createElement(name);
  if (kind) made.className = kind;
  made.textContent = text;
  return made;
}

function marked(text, spans) {
  const parts = [];
  let done = 0;
  for (const { severity, start, end } of spans) {
    const within = text.slice(start, end);
    const shown = within === "\n" || within === "" ? ` ${within}` : within;
    parts.push(text.slice(done, start), element("mark", severity, shown));
    done = end;
  }
  // The line below the last keeps both layers of one height, with and without a scroll bar.
  return [...parts, `${text.slice(done)}\n\n\n`];
}

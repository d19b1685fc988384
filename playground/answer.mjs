// The side of the answer: shows the verdict that `playground/session.py` words, files to keep, and the report in a frame of its own.
import { element } from "./editor.mjs";

const TONES = { realizable: "good", unrealizable: "bad", undecided: "doubt", mistakes: "bad" };

export class Answer {
  constructor() {
    [this.verdict, this.hint, this.frame] = ["verdict", "hint", "report"].map((id) => document.getElementById(id));
    this.address = null;
  }

  // What is shown no longer fits the text.
  outdate() {
    this.verdict.classList.add("old");
  }

  begin() {
    this.outdate();
    this.put(null);
  }

  answered({ verdict, heading, lines, files }) {
    this.hint.hidden = true;
    this.verdict.classList.remove("old");
    this.buttons = element("div", "buttons", "");
    for (const [name, text] of Object.entries(files)) this.offer(name, "application/json", text);
    const below = lines.map((line) => element("p", "", line));
    this.verdict.replaceChildren(element("h2", TONES[verdict], heading), ...below, this.buttons);
  }

  reported(page) {
    if (!page) return;
    this.offer("report.html", "text/html", page);
    this.put(page);
  }

  offer(name, type, text) {
    const button = element("button", "", `Save ${name}`);
    button.addEventListener("click", () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text], { type }));
      link.download = name;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
    });
    this.buttons.append(button);
  }

  put(page) {
    if (this.address !== null) URL.revokeObjectURL(this.address);
    this.address = page === null ? null : URL.createObjectURL(new Blob([page], { type: "text/html" }));
    this.frame.hidden = page === null;
    if (page !== null) this.frame.src = this.address;
  }
}

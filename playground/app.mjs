// The playground: a text is checked while it is written, and solved when that is asked for.
import { Answer } from "./answer.mjs";
import { Editor } from "./editor.mjs";
import { Python } from "./python.mjs";
import { fragmentOf, textIn } from "./sharing.mjs";

// Milliseconds after the last key before a text is checked.
const PAUSE = 120;
const FIRST = "amr";

const [solve, cancel, share, menu, status] =
  ["solve", "cancel", "share", "examples", "status"].map((id) => document.getElementById(id));
const answer = new Answer();
const editor = new Editor(changed);
let version = 0;
let pause;

const python = new Python({
  ready: () => say("Ready."),
  stage: ({ stage }) => say(`${stage[0].toUpperCase()}${stage.slice(1)} …`),
  checked({ version: of, problems }) {
    if (of === version) editor.show(problems);
  },
  answered(message) {
    answer.answered(message);
    if (message.version === version) editor.show(message.problems);
    else answer.outdate();
    document.body.dataset.answered = Math.round(message.milliseconds);
  },
  reported({ page }) {
    answer.reported(page);
    say("Ready.");
  },
  failed: ({ message }) => say(`This is a bug of the playground: ${message.trim().split("\n").at(-1)}`, "bad"),
  broken: ({ message }) => say(`Python does not start here: ${message}`, "bad"),
});

function say(text, tone = "") {
  status.textContent = text;
  status.className = tone;
  solve.disabled = !python.isReady || python.isRunning;
  cancel.hidden = !python.isRunning;
}

function check() {
  python.check({ version, text: editor.text });
}

function changed() {
  version += 1;
  menu.value = "";
  answer.outdate();
  clearTimeout(pause);
  pause = setTimeout(check, PAUSE);
}

function put(text, name) {
  version += 1;
  clearTimeout(pause);
  editor.text = text;
  menu.value = name;
  answer.outdate();
  check();
}

function run() {
  if (solve.disabled) return;
  answer.begin();
  python.solve({ version, text: editor.text });
  say("Reading the specification …");
}

solve.addEventListener("click", run);
document.addEventListener("keydown", (event) => {
  if (event.key !== "Enter" || !(event.ctrlKey || event.metaKey)) return;
  event.preventDefault();
  run();
});
cancel.addEventListener("click", () => {
  python.cancel();
  check();
  say("Cancelled. Python is starting anew …");
});
share.addEventListener("click", async () => {
  history.replaceState(null, "", await fragmentOf(editor.text));
  try {
    await navigator.clipboard.writeText(location.href);
    share.textContent = "Link copied";
  } catch {
    share.textContent = "The link is in the address bar";
  }
  setTimeout(() => { share.textContent = "Copy link"; }, 3000);
});

async function putShared() {
  try {
    const text = await textIn(location.hash);
    if (text !== null) put(text, "");
    return text !== null;
  } catch {
    say("The link is damaged: there is no text in it.", "bad");
    return false;
  }
}

const examples = await (await fetch("examples.json")).json();
for (const name of Object.keys(examples)) menu.add(new Option(name, name));
menu.addEventListener("change", () => {
  if (menu.value) put(examples[menu.value], menu.value);
});
addEventListener("hashchange", putShared);
if (!(await putShared())) put(examples[FIRST], FIRST);

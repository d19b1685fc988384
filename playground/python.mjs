// Python in a worker: questions to it, and what it tells. A run is cancelled by ending the worker and starting another.

export class Python {
  // `told` has a function for every kind of message.
  constructor(told) {
    this.told = told;
    this.start();
  }

  start() {
    this.isReady = this.isRunning = false;
    this.unchecked = this.checking = null;
    this.worker = new Worker("worker.mjs", { type: "module" });
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.worker.onerror = (event) => this.told.broken({ message: event.message ?? "the worker cannot be loaded" });
  }

  hear(message) {
    if (message.kind === "ready") this.isReady = true;
    if (message.kind === "checked") this.checking = null;
    if (message.kind === "reported" || message.kind === "failed") this.isRunning = false;
    this.told[message.kind](message);
    this.checkNext();
  }

  // Only the newest text waits to be checked.
  check(question) {
    this.unchecked = question;
    this.checkNext();
  }

  checkNext() {
    if (!this.isReady || this.checking !== null || this.unchecked === null) return;
    this.checking = this.unchecked;
    this.unchecked = null;
    this.worker.postMessage({ kind: "check", ...this.checking });
  }

  solve(question) {
    this.isRunning = true;
    this.worker.postMessage({ kind: "solve", ...question });
  }

  cancel() {
    this.worker.terminate();
    this.start();
  }
}

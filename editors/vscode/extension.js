// Starts the language server, `tumato-sym lsp`, and shows what it says.
"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function start() {
  const [command, ...args] = vscode.workspace.getConfiguration("tumato").get("command");
  client = new LanguageClient("tumato", "Tumato", { command, args }, { documentSelector: [{ language: "tumato" }] });
  try {
    await client.start();
  } catch (error) {
    const way = "Install it with: pip install 'tumato-symbolic[lsp]', or set tumato.command.";
    vscode.window.showErrorMessage(`${command} cannot be started: ${error.message}. ${way}`);
  }
}

async function stop() {
  if (client !== undefined && client.isRunning()) {
    await client.stop();
  }
}

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("tumato.restart", async () => {
      await stop();
      await start();
    })
  );
  await start();
}

module.exports = { activate, deactivate: stop };

// Uses a playground in Chromium: { address, wrong, slow, pictures } as JSON in, what was seen of it as JSON out.
const { existsSync, readFileSync } = require("node:fs");
const { chromium } = require("playwright-core");

const ARGUMENTS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

// `wrong` is a text with a mistake, `slow` takes long enough to be cancelled; pictures go to a folder, if one is named.
async function used(browser, { address, wrong, slow, pictures }) {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
  page.setDefaultTimeout(60000);
  const seen = { errors: [], requests: [] };
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && seen.errors.push(message.text()));
  page.on("pageerror", (error) => seen.errors.push(String(error)));
  page.on("request", (request) => [address, "blob:", "data:"].some((start) => request.url().startsWith(start)) || seen.requests.push(request.url()));
  const said = (text) => page.locator(`#status:text-is("${text}")`).waitFor();
  const picture = async (name) => {
    if (!pictures) return;
    for (const colorScheme of ["light", "dark"]) {
      await page.emulateMedia({ colorScheme });
      await page.screenshot({ path: `${pictures}/${name}-${colorScheme}.png` });
    }
    await page.emulateMedia({ colorScheme: "light" });
  };
  const kept = async (name) => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(`text=Save ${name}`)]);
    return readFileSync(await download.path(), "utf-8");
  };
  const solved = async () => {
    await page.evaluate(() => { delete document.body.dataset.answered; });
    await page.keyboard.press("Control+Enter");
    await page.locator("body[data-answered]").waitFor();
    await said("Ready.");
    return Number(await page.getAttribute("body", "data-answered"));
  };

  await page.goto(address);
  await said("Ready.");
  seen.ready = await page.evaluate(() => performance.now());
  await picture("ready");
  seen.cold = await solved();
  seen.warm = [await solved(), await solved(), await solved()];
  seen.verdict = await page.textContent("#verdict");
  seen.policy = await kept("policy.json");
  const report = page.frameLocator("#report");
  await report.locator(".check p:not(:has-text('by now'))").first().waitFor();
  seen.check = await report.locator(".check").textContent();
  await picture("policy");
  await report.locator("a.line").first().click();
  seen.line = await report.locator(".listing li:target").textContent();

  await page.fill("#text", wrong);
  await page.locator("#problems .error").first().waitFor();
  seen.problems = await page.locator("#problems li").allTextContents();
  seen.marked = await page.locator("#marks mark.error").allTextContents();
  seen.numbered = await page.locator("#gutter .error").allTextContents();
  await picture("wrong");
  await solved();
  seen.refused = await page.textContent("#verdict");

  await page.click("#share");
  await page.locator("#share:not(:text-is('Copy link'))").waitFor();
  const shared = await browser.newPage();
  await shared.goto(page.url());
  await shared.waitForFunction(() => document.getElementById("text").value !== "");
  seen.shared = await shared.inputValue("#text");
  await shared.close();

  await page.selectOption("#examples", "two_robots");
  await solved();
  seen.none = await page.textContent("#verdict");
  await report.locator("#panel-reasons").waitFor();
  await picture("no-policy");

  await page.fill("#text", slow);
  await page.keyboard.press("Control+Enter");
  await page.click("#cancel");
  await said("Ready.");
  await page.selectOption("#examples", "coin");
  await solved();
  seen.afterwards = await page.textContent("#verdict");
  await page.close();
  return seen;
}

async function main() {
  const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
  const browser = await chromium.launch({ executablePath, args: ARGUMENTS });
  console.log(JSON.stringify(await used(browser, JSON.parse(readFileSync(0, "utf-8")))));
  await browser.close();
}

main();

// Opens pages in Chromium and uses them: [{ page, other }, …] as JSON in, what was seen of each as JSON out. With
// { page, acts }, what was read on the way.
const { existsSync, readFileSync } = require("node:fs");
const { pathToFileURL } = require("node:url");
const { chromium } = require("playwright-core");

const ARGUMENTS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

async function opened(browser, path, seen) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && seen.errors.push(message.text()));
  page.on("pageerror", (error) => seen.errors.push(String(error)));
  page.on("request", (request) => request.url().startsWith("file:") || seen.requests.push(request.url()));
  await page.goto(pathToFileURL(path).href);
  return page;
}

// What is read on a page where some things are done, one after the other.
async function read(browser, { page: path, acts }) {
  const seen = { errors: [], requests: [], read: [] };
  const page = await opened(browser, path, seen);
  await page.locator(".check p:not(:has-text('by now'))").first().waitFor({ timeout: 120000 });
  const does = {
    click: (selector) => page.locator(selector).first().click(),
    choose: (selector, label) => page.selectOption(selector, { label }),
    scroll: (selector, top) => page.$eval(selector, (element, to) => { element.scrollTop = to; }, top),
    text: async (selector) => seen.read.push((await page.locator(selector).allTextContents()).join("\n")),
    property: async (selector, name) => seen.read.push(await page.$eval(selector, (element, of) => element[of], name)),
  };
  for (const [act, ...details] of acts) await does[act](...details);
  await page.close();
  return seen;
}

// What a page shows when it is opened, filtered, stepped through and compared.
async function used(browser, { page: path, other }) {
  const seen = { errors: [], requests: [] };
  const page = await opened(browser, path, seen);
  seen.painted = await page.evaluate(() => new Promise((done) => {
    const look = () => requestAnimationFrame(() => (document.querySelector("h1") ? done(performance.now()) : look()));
    look();
  }));
  seen.title = await page.textContent("h1");
  const text = (selector) => page.textContent(selector);
  if (!(await page.locator("#tab-table").count())) {
    await page.locator(".check p:not(:has-text('by now'))").first().waitFor({ timeout: 60000 });
    seen.check = await text(".check");
    seen.reasons = await text("#panel-reasons");
    const link = page.locator("#panel-reasons a.line").first();
    if (await link.count()) {
      await link.click();
      seen.line = await page.evaluate(() => document.querySelector(".listing li:target")?.textContent);
    }
    await page.close();
    return seen;
  }
  await page.locator(".check p:not(:has-text('by now'))").first().waitFor({ timeout: 120000 });
  seen.check = await text(".check");
  seen.decisions = await text(".decisions");
  seen.rows = await page.locator("#panel-table tbody tr").count();
  await page.locator(".variable .chip").first().click();
  seen.filtered = await text(".filter [role=status]");
  seen.state = await text(".state");
  await page.click("#tab-rules");
  seen.rules = await page.locator("#panel-rules li").count();
  seen.lit = await page.locator("#panel-rules .lit").count();
  await page.click("#tab-graph");
  seen.boxes = await page.locator("#panel-graph .box").count();
  await page.click("#tab-execution");
  if (await page.locator("[data-key=nominal]").count()) {
    await page.click("[data-key=nominal]");
    seen.steps = await page.locator(".trace li").count();
    await page.click("[data-key=execute]");
    seen.executed = await page.textContent("#panel-execution ul");
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-key=itf]")]);
    seen.itf = JSON.parse(readFileSync(await download.path(), "utf-8"));
  }
  await page.click("#tab-compare");
  await page.setInputFiles("#panel-compare input", other);
  await page.locator("#panel-compare [role=status] > *").first().waitFor();
  seen.compared = await page.textContent("#panel-compare [role=status]");
  await page.setViewportSize({ width: 390, height: 844 });
  seen.wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  await page.focus("#tab-compare");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  seen.turned = await page.evaluate(() => document.activeElement.id);
  const top = () => page.evaluate(() => Math.abs(document.querySelector(".state").getBoundingClientRect().top) < 20);
  seen.visited = [await top()];
  await page.locator("#panel-table tbody .link").first().click();
  seen.visited.push(await top());
  await page.click(".back");
  seen.visited.push(await top());
  await page.close();
  return seen;
}

async function main() {
  const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
  const browser = await chromium.launch({ executablePath, args: ARGUMENTS });
  const found = [];
  for (const each of JSON.parse(readFileSync(0, "utf-8"))) found.push(await (each.acts ? read : used)(browser, each));
  await browser.close();
  console.log(JSON.stringify(found));
}

main();

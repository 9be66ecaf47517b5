// Shows a page in headless Chromium and keeps what the page hands over: the shared part of the adapters.
//   node shoot.mjs three/page.html model.glb OUT [name=value ...]
// The page gets its settings (settings.mjs) in location.search and calls save(name, array, shape) for each picture (NPY) and done(frame)
// with the object of frame.json. Chromium draws with its software renderer (SwiftShader), so no GPU is needed.
import { spawn } from "node:child_process";
import { createReadStream, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { settings_of } from "./settings.mjs";

const here = path.dirname(fileURLToPath(import.meta.url));
const [page, model, out, ...given] = process.argv.slice(2);
function wrong(message) {
  console.error(message);
  process.exit(2);
}
if (!out) wrong("usage: node shoot.mjs PAGE MODEL.glb OUT [name=value ...]");
if (!existsSync(path.join(here, page))) wrong(`There is no page ${page} in ${here}.`);
if (!existsSync(model)) wrong(`There is no model ${model}.`);
let settings, lines = "";
try {
  settings = settings_of(page, given);
  if (settings.lines) lines = readFileSync(settings.lines, "utf8");
} catch (error) {
  wrong(error.message);
}

const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".wasm": "application/wasm" };
const modules = process.env.NODE_MODULES ?? path.join(here, "node_modules");
// /model/... is the model's folder, /node_modules/... the packages, the rest this folder.
function file_of(url) {
  const wanted = decodeURIComponent(new URL(url, "http://x").pathname);
  const roots = { "/model/": path.dirname(path.resolve(model)), "/node_modules/": modules, "/": here };
  const prefix = Object.keys(roots).find((p) => wanted.startsWith(p));
  const file = path.join(roots[prefix], wanted.slice(prefix.length));
  return file.startsWith(roots[prefix]) && existsSync(file) ? file : null;
}
function body_of(request) {
  return new Promise((resolve) => {
    const parts = [];
    request.on("data", (part) => parts.push(part));
    request.on("end", () => resolve(Buffer.concat(parts)));
  });
}
const white = Buffer.from("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8/5+hHgAHggJ/PchI7wAAAABJRU5ErkJggg==", "base64");
let finish;
const finished = new Promise((resolve) => (finish = resolve));
const server = createServer(async (request, response) => {
  if (request.method === "POST") {
    const name = path.basename(request.url), body = await body_of(request);
    if (name === "failed") finish(body.toString() + "\n" + log.split("\n").filter((line) => line.includes("CONSOLE")).slice(-20).join("\n"));
    else if (name === "refused") finish(body.toString());
    else if (name === "note") console.log(body.toString());
    else {
      mkdirSync(out, { recursive: true });
      writeFileSync(path.join(out, name), body);
    }
    response.end();
    if (name === "frame.json") finish("");
    return;
  }
  if (request.url === "/lines") return response.end(lines);
  const file = file_of(request.url);
  if (!file && /\.(png|jpe?g)$/i.test(new URL(request.url, "http://x").pathname)) {
    response.writeHead(200, { "Content-Type": "image/png" }); // shadows need no textures, so a missing one is white
    return response.end(white);
  }
  response.writeHead(file ? 200 : 404, { "Content-Type": types[path.extname(file ?? "")] ?? "application/octet-stream" });
  if (file) createReadStream(file).pipe(response);
  else response.end();
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));

const profile = mkdtempSync(path.join(tmpdir(), "shoot-"));
const query = new URLSearchParams({ model: "/model/" + path.basename(model), scene: path.relative(out, model), settings: JSON.stringify(settings) });
const chromium = spawn(process.env.CHROMIUM ?? "chromium", [
  "--headless", "--no-sandbox", "--no-first-run", "--disable-background-networking", "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--enable-logging=stderr", `--user-data-dir=${profile}`,
  `http://127.0.0.1:${server.address().port}/${page}?${query}`], { stdio: ["ignore", "ignore", "pipe"] });
let log = "";
chromium.stderr.on("data", (text) => (log += text));
const limit = Number(process.env.SHOOT_SECONDS ?? 300);
const timer = setTimeout(() => finish(`no frame after ${limit} s`), 1000 * limit);
chromium.on("error", (error) => finish(error.message));
const failure = await finished;
clearTimeout(timer);
chromium.kill("SIGKILL");
await new Promise((resolve) => (chromium.exitCode === null && chromium.signalCode === null ? chromium.on("exit", resolve) : resolve()));
server.close();
for (let i = 0; i < 50 && existsSync(profile); ++i) // its child processes end a little later
  try {
    rmSync(profile, { recursive: true, force: true });
  } catch {
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
if (failure) {
  console.error(failure);
  process.exit(1);
}
console.log(path.join(out, "frame.json"));
process.exit(0);

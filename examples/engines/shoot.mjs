// Shows a page in headless Chromium and keeps what the page hands over: the shared part of the adapters.
//   node shoot.mjs three/page.html model.glb OUT [name=value ...]
// The page gets its settings (settings.mjs) in location.search and calls save(name, array, shape) for each picture (NPY) and done(frame)
// with the object of frame.json. Chromium draws with its software renderer (SwiftShader), so no GPU is needed.
// However it ends, Chromium ends too.
import { spawn } from "node:child_process";
import { createReadStream, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
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
const roots = { "/model/": path.dirname(path.resolve(model)), "/node_modules/": path.resolve(modules), "/": here };
// The file that an address names; null: there is none, or it lies elsewhere. Each part of the path is decoded once.
function file_of(address) {
  let wanted;
  try {
    wanted = address.split(/[?#]/)[0].split("/").map(decodeURIComponent).join("/");
  } catch {
    return null; // "%zz"
  }
  const prefix = Object.keys(roots).find((p) => wanted.startsWith(p));
  if (!prefix || wanted.includes("\0")) return null;
  const file = path.join(roots[prefix], wanted.slice(prefix.length));
  return file.startsWith(path.join(roots[prefix], path.sep)) && statSync(file, { throwIfNoEntry: false })?.isFile() ? file : null;
}
function body_of(request) {
  return new Promise((resolve, reject) => {
    const parts = [];
    request.on("data", (part) => parts.push(part));
    request.on("end", () => resolve(Buffer.concat(parts)));
    request.on("error", reject);
  });
}
const white = Buffer.from("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8/5+hHgAHggJ/PchI7wAAAABJRU5ErkJggg==", "base64");
let finish; // with why there is no frame; "": there is one
const finished = new Promise((resolve) => (finish = resolve));
async function received(request) {
  const name = path.basename(request.url), body = await body_of(request);
  if (name === "failed") finish(body.toString() + "\n" + log.split("\n").filter((line) => line.includes("CONSOLE")).slice(-20).join("\n"));
  else if (name === "refused") finish(body.toString());
  else if (name === "note") console.log(body.toString());
  else {
    mkdirSync(out, { recursive: true });
    writeFileSync(path.join(out, name), body);
    if (name === "frame.json") finish("");
  }
}
// A model may name any address. The page loads nothing but what this server has, so no other is asked for it.
const policy = "default-src 'self' data: blob: 'unsafe-inline' 'unsafe-eval'";
async function answer(request, response) {
  const own = `127.0.0.1:${server.address().port}`;
  if (request.headers.host !== own || (request.method === "POST" && request.headers.origin !== `http://${own}`)) {
    response.writeHead(403); // a page of another program, which may open any address too
    return response.end();
  }
  if (request.method === "POST") {
    await received(request);
    return response.end();
  }
  if (request.url === "/lines") return response.end(lines);
  const file = file_of(request.url);
  if (!file && /\.(png|jpe?g)$/i.test(request.url.split(/[?#]/)[0])) {
    response.writeHead(200, { "Content-Type": "image/png" }); // shadows need no textures, so a missing one is white
    return response.end(white);
  }
  response.writeHead(file ? 200 : 404, { "Content-Type": types[path.extname(file ?? "")] ?? "application/octet-stream", "Content-Security-Policy": policy });
  if (file) createReadStream(file).pipe(response);
  else response.end();
}
const server = createServer((request, response) => answer(request, response).catch((error) => finish(error.message)));
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));

const profile = mkdtempSync(path.join(tmpdir(), "shoot-"));
const query = new URLSearchParams({ model: "/model/" + encodeURIComponent(path.basename(model)), scene: path.relative(out, model), settings: JSON.stringify(settings) });
let chromium, log = "", ended = false;
// Without its sandbox only where there can be none: Chromium has none for root, and says itself where the system has none.
function open(sandbox) {
  if (!sandbox) console.log(`note: Chromium runs without its sandbox, because ${root ? "it has none for root" : "this system gives it none"}.`);
  // The pipe of --remote-debugging-pipe is for its end alone: Chromium ends when this program does, however that ends.
  chromium = spawn(process.env.CHROMIUM ?? "chromium", [
    "--headless", ...(sandbox ? [] : ["--no-sandbox"]), "--no-first-run", "--disable-background-networking", "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
    "--remote-debugging-pipe", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--enable-logging=stderr", `--user-data-dir=${profile}`,
    `http://127.0.0.1:${server.address().port}/${page}?${query}`], { stdio: ["ignore", "ignore", "pipe", "pipe", "pipe"], env: { ...process.env, TMPDIR: profile } });
  chromium.stderr.on("data", (text) => (log += text));
  for (const pipe of chromium.stdio.slice(3)) pipe.on("error", () => {}); // Chromium's end closes them
  chromium.on("error", (error) => finish(error.message));
  chromium.on("close", (code, signal) => {
    if (sandbox && !ended && log.includes("No usable sandbox")) open(false);
    else finish(`Chromium ended (${signal ?? code}) before the frame: ${log.trim().split("\n").at(-1)}`);
  });
}
const root = process.getuid() === 0;
const limit = Number(process.env.SHOOT_SECONDS ?? 300);
const timer = setTimeout(() => finish(`no frame after ${limit} s`), 1000 * limit);
for (const signal of ["SIGINT", "SIGTERM", "SIGHUP"]) process.on(signal, () => finish(`ended by ${signal}`));
open(!root);
const failure = await finished;
ended = true;
clearTimeout(timer);
chromium.kill("SIGKILL");
await new Promise((resolve) => { // its child processes end a little later, and then nobody has the log open
  chromium.on("close", resolve);
  setTimeout(resolve, 2000);
});
for (let i = 0; i < 50 && existsSync(profile); ++i)
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

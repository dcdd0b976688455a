// A helper's worker of tests/web/render.mjs. workerData: { engine, work }.
import { parentPort, workerData } from "node:worker_threads";

const { Engine } = await import(workerData.engine);
Engine.help(workerData.work, () => parentPort.postMessage({}));

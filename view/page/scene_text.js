// SPDX-License-Identifier: Apache-2.0
// A dialog with values for the scene file: to copy, or to be written into the file.
import {command} from "./server.js";

const element = id => document.getElementById(id);

// `name` and `values`: of a command that takes the action "text" or "write". `onWritten`: called after writing.
export async function offerText(title, name, values, onWritten = () => {}) {
  const dialog = element("scene_text"), write = element("write_text"), message = element("text_message");
  element("text_title").textContent = title;
  message.textContent = "";
  write.disabled = element("copy_text").disabled = true;
  element("text").value = "";
  if (!dialog.open) dialog.showModal();
  const run = async action => {
    try {
      return await command(name, {...values, action});
    } catch (problem) {
      message.textContent = problem.message;
      return null;
    }
  };
  const answer = await run("text");
  if (!answer) return;
  element("text").value = answer.text;
  write.disabled = element("copy_text").disabled = false;
  write.onclick = async () => {
    write.disabled = true;
    if (!await run("write")) return;
    dialog.close();
    onWritten();
  };
}

element("copy_text").addEventListener("click", () => {
  element("text").select();
  navigator.clipboard?.writeText(element("text").value).catch(() => {});
  element("text_message").textContent = "copied";
});
element("close_text").addEventListener("click", () => element("scene_text").close());

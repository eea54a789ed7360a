// A page in headless Chromium: a script added to it reports what it finds there.
#pragma once
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace pellucid::test {

inline bool haveBrowser() {
  return std::system("command -v chromium >/dev/null") == 0;
}

// Runs `script` when the page is ready; it fills the object `out`, which comes back. Beside it stand $(id), at(canvas,
// x, y) and set(id, value), which tells the page. "error" holds what went wrong.
inline nlohmann::json probePage(const std::string& folder, const std::string& page, const std::string& script) {
  std::string text = slurp(page);
  const std::string probe = R"JS(<pre id="probe"></pre><script>
pellucid.ready.then(() => {
  const out = {};
  const find = id => document.getElementById(id);
  const at = (canvas, x, y) => Array.from(canvas.getContext('2d').getImageData(x, y, 1, 1).data).slice(0, 3);
  const set = (id, value) => { find(id).value = value; find(id).dispatchEvent(new Event('input')); };
)JS" + script + R"JS(
  find('probe').textContent = 'PROBE' + JSON.stringify(out) + 'END';
}).catch(e => { document.getElementById('probe').textContent = 'PROBE' + JSON.stringify({error: String(e)}) + 'END'; });
</script>)JS";
  text.insert(text.find("</body>"), probe);
  std::ofstream(folder + "/probed.html") << text;
  const std::string command = "timeout 90 chromium --headless --no-sandbox --disable-gpu --user-data-dir=" + folder +
                              "/profile --virtual-time-budget=20000 --dump-dom file://" + folder + "/probed.html > " +
                              folder + "/dom.txt 2>" + folder + "/chromium.txt";
  if (std::system(command.c_str()) != 0) return {{"error", slurp(folder + "/chromium.txt")}};
  const std::string dom = slurp(folder + "/dom.txt");
  const std::size_t from = dom.rfind("PROBE{"), to = dom.find("END", from);
  if (from == std::string::npos) return {{"error", slurp(folder + "/chromium.txt")}};
  return nlohmann::json::parse(dom.substr(from + 5, to - from - 5));
}

}  // namespace pellucid::test

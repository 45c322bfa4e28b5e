#include "runtime/bundle/audit.hpp"

#include <nlohmann/json.hpp>

#include "runtime/bundle/durable.hpp"
#include "runtime/bundle/manifest.hpp"

namespace taktwerk::runtime {

Result<void> write_audit(const std::filesystem::path& machine_folder, const Deed& deed, const AuditLine& line) {
    using Json = nlohmann::ordered_json;
    Json out{{"time", utc_text(deed.when)}, {"who", deed.who}, {"did", line.did}, {"from", line.from}, {"to", line.to}};
    if (!line.why.empty()) out["why"] = line.why;
    return append_line(machine_folder / "audit.log", out.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace taktwerk::runtime

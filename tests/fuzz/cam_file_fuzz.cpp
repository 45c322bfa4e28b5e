// Any bytes as a cam's CSV file: points that rise, or errors with a sentence and a remedy.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "config/machine_file/cam_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace taktwerk;
    const auto file = config::parse_cam_file("fuzz.csv", {reinterpret_cast<const char*>(data), size}, {"deg", "mm"});
    for (const auto& error : file.errors)
        if (error.what.empty() || error.remedy.empty() || error.subject.rfind("fuzz.csv", 0) != 0) std::abort();
    if (!file.errors.empty()) return 0;
    if (file.points.size() < 2 || file.points.size() > config::max_cam_points || file.points.size() != file.lines.size()) std::abort();
    for (std::size_t i = 0; i < file.points.size(); ++i) {
        const auto& p = file.points[i];
        if (!std::isfinite(p.master) || !std::isfinite(p.slave) || !std::isfinite(p.velocity)) std::abort();
        if (i > 0 && !(p.master > file.points[i - 1].master)) std::abort();
    }
    return 0;
}

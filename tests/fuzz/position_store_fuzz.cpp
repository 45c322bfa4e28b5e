// Any bytes as a slot of the position store: nothing, or axes whose numbers are numbers and that read back the same after a save.
// The check sum is put right in half of the inputs, or none but the whole ones would get through.
#include <cmath>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "core/crc32.hpp"
#include "runtime/positions/position_store.hpp"
#include "tests/fuzz/scratch_folder.hpp"

using namespace taktwerk;
using namespace taktwerk::runtime;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::ScratchFolder folder;
    if (size == 0) return 0;
    std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (data[0] & 1) text += fmt::format("crc {:08x}\n", crc32(std::as_bytes(std::span(text.data(), text.size()))));
    folder.write("positions.0", text);
    std::error_code ignored;
    std::filesystem::remove(folder.path() / "positions.1", ignored);

    PositionStore store(folder.path());
    const auto loaded = store.load();
    for (const auto& error : loaded.damage)
        if (error.what.empty() || error.subject.empty()) std::abort();
    if (loaded.lost && !loaded.axes.empty()) std::abort();
    for (const auto& axis : loaded.axes)
        if (axis.name.empty() || !std::isfinite(axis.position.shift) || !std::isfinite(axis.gearing.feed)) std::abort();
    if (loaded.axes.empty()) return 0;

    if (!store.save(loaded.axes)) std::abort();
    const auto again = PositionStore(folder.path()).load();
    if (again.axes.size() != loaded.axes.size()) std::abort();
    for (std::size_t i = 0; i < loaded.axes.size(); ++i)
        if (again.axes[i].name != loaded.axes[i].name || !(again.axes[i].position == loaded.axes[i].position) ||
            !axes::same_coordinates(again.axes[i].gearing, loaded.axes[i].gearing))
            std::abort();
    return 0;
}

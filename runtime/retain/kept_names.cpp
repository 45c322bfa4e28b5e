#include "runtime/retain/kept_names.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "runtime/retain/value_type.hpp"

namespace taktwerk::runtime {

std::optional<std::string> name_kept_twice(std::span<const RetainedItem> items, std::size_t first) {
    std::vector<std::pair<std::string, std::size_t>> names;
    for (std::size_t i = 0; i < items.size(); ++i) {
        names.emplace_back(items[i].name, i);
        if (items[i].block == nullptr) continue;
        for (const auto& pin : items[i].block->pins)
            if (size_of(pin.type.kind) != 0) names.emplace_back(fmt::format("{}.{}", items[i].name, pin.name), i);
    }
    std::sort(names.begin(), names.end());
    for (std::size_t n = 1; n < names.size(); ++n) {
        const auto& [name, a] = names[n - 1];
        const auto& [same, b] = names[n];
        const bool own = items[a].name == items[b].name && items[a].program == items[b].program;
        if (name == same && !own && std::max(a, b) >= first) return name;
    }
    return std::nullopt;
}

}  // namespace taktwerk::runtime

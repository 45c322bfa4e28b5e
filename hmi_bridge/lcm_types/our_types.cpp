#include "hmi_bridge/lcm_types/our_types.hpp"

#include <array>
#include <cstdlib>
#include <utility>

namespace taktwerk::hmi {
namespace {

/// Their texts, by the build: {"heartbeat_v1_t.lcm", R"lcm(...)lcm"}, ...
constexpr std::pair<const char*, std::string_view> texts[]{
#include <taktwerk_lcm_texts.inc>
};

}  // namespace

TypeCatalog our_types() {
    TypeCatalog catalog;
    for (const auto& [file, text] : texts)
        if (!catalog.add(text, file)) std::abort();  // lcm-gen has read it in the same build
    return catalog;
}

}  // namespace taktwerk::hmi

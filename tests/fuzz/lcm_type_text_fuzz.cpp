// Any bytes as a .lcm file, and what is behind its first NUL as a message of its first type: words that say where, or a type whose fingerprint ends and whose reader does.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include <nlohmann/json.hpp>

#include "hmi_bridge/lcm_types/message_reader.hpp"
#include "hmi_bridge/lcm_types/type_catalog.hpp"

using namespace taktwerk::hmi;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 4096) return -1;
    const std::string_view all(reinterpret_cast<const char*>(data), size);
    const auto end = std::min(all.find('\0'), all.size());
    TypeCatalog catalog;
    if (const auto added = catalog.add(all.substr(0, end), "x.lcm"); !added) {
        if (added.error().code != "lcm.type_text" || added.error().what.empty()) std::abort();
        return 0;
    }
    for (const auto& [name, type] : catalog.types()) {
        auto fingerprint = catalog.fingerprint(type);
        if (!fingerprint) continue;
        std::vector<std::byte> message(8);
        for (int i = 7; i >= 0; --i, *fingerprint >>= 8) message[static_cast<std::size_t>(i)] = static_cast<std::byte>(*fingerprint);
        const auto body = all.substr(std::min(end + 1, all.size()));
        for (const char c : body) message.push_back(static_cast<std::byte>(c));
        static_cast<void>(check_message(catalog, type, message).ok());
        break;
    }
    return 0;
}

// Any bytes as a message of one of our types: it is refused in words, or it is one, and then lcm-gen's decoder takes it to its last byte. The first byte chooses
// the type, whose fingerprint is put in front, or none would get through.
#include <cstdlib>
#include <vector>

#include <nlohmann/json.hpp>

#include "hmi_bridge/lcm_types/message_reader.hpp"
#include "hmi_bridge/lcm_types/our_types.hpp"
#include "hmi_bridge/lcm_types/shown_message.hpp"
#include "taktwerk_lcm/acknowledge_v1_t.hpp"
#include "taktwerk_lcm/alarm_list_v1_t.hpp"
#include "taktwerk_lcm/axis_holder_v1_t.hpp"
#include "taktwerk_lcm/axis_state_v1_t.hpp"
#include "taktwerk_lcm/command_event_v1_t.hpp"
#include "taktwerk_lcm/command_v1_t.hpp"
#include "taktwerk_lcm/cycle_statistics_v1_t.hpp"
#include "taktwerk_lcm/heartbeat_v1_t.hpp"
#include "taktwerk_lcm/io_state_v1_t.hpp"
#include "taktwerk_lcm/machine_state_v1_t.hpp"
#include "taktwerk_lcm/program_values_v1_t.hpp"

using namespace taktwerk::hmi;

namespace {

template <class Message>
void try_as(const TypeCatalog& catalog, std::span<const std::byte> body) {
    const auto& type = *catalog.find(std::string("taktwerk_lcm.") + Message::getTypeName());
    auto fingerprint = static_cast<std::uint64_t>(Message::getHash());
    std::vector<std::byte> message(8);
    for (int i = 7; i >= 0; --i, fingerprint >>= 8) message[static_cast<std::size_t>(i)] = static_cast<std::byte>(fingerprint);
    message.insert(message.end(), body.begin(), body.end());
    const auto checked = check_message(catalog, type, message);
    const auto read = read_message(catalog, type, message);
    if (checked.ok() != read.ok()) std::abort();
    if (!checked) {
        if (!checked.error().code.starts_with("lcm.") || checked.error().what.empty()) std::abort();
        return;
    }
    for (const auto& line : shown_lines(catalog, type, *read))
        for (const char c : line)
            if (static_cast<unsigned char>(c) < 0x20) std::abort();
    Message decoded{};
    if (decoded.decode(message.data(), 0, static_cast<int>(message.size())) != static_cast<int>(message.size())) std::abort();
    if (decoded.getEncodedSize() != static_cast<int>(message.size())) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace taktwerk_lcm;
    static const auto catalog = our_types();
    if (size == 0) return 0;
    const std::span body(reinterpret_cast<const std::byte*>(data) + 1, size - 1);
    switch (data[0] % 11) {
        case 0: try_as<acknowledge_v1_t>(catalog, body); break;
        case 1: try_as<alarm_list_v1_t>(catalog, body); break;
        case 2: try_as<axis_holder_v1_t>(catalog, body); break;
        case 3: try_as<axis_state_v1_t>(catalog, body); break;
        case 4: try_as<command_event_v1_t>(catalog, body); break;
        case 5: try_as<command_v1_t>(catalog, body); break;
        case 6: try_as<cycle_statistics_v1_t>(catalog, body); break;
        case 7: try_as<heartbeat_v1_t>(catalog, body); break;
        case 8: try_as<io_state_v1_t>(catalog, body); break;
        case 9: try_as<machine_state_v1_t>(catalog, body); break;
        default: try_as<program_values_v1_t>(catalog, body); break;
    }
    return 0;
}

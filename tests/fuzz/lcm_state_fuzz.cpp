// Any bytes on the channel of whole states: what is no whole state is counted, and what is one becomes JSON that any reader takes and writes back as it came. The first byte
// says whether its check is made right, or hardly any would get through; the fingerprint is put in front.
#include <cstdlib>
#include <vector>

#include <nlohmann/json.hpp>

#include "hmi_bridge/lcm/whole_message.hpp"
#include "hmi_bridge/lcm/whole_states.hpp"
#include "hmi_bridge/socket/json_state.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi;

namespace {

constexpr std::size_t check_at = 44, check_size = 8;  // whole_state_v5_t.lcm: behind 8 + 8 + 8 + 4 + 8 + 8 bytes

void put_big_endian(std::vector<std::byte>& message, std::size_t at, std::uint64_t value) {
    for (std::size_t i = 8; i-- > 0; value >>= 8) message[at + i] = static_cast<std::byte>(value);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    std::vector<std::byte> message(8);
    put_big_endian(message, 0, static_cast<std::uint64_t>(taktwerk_lcm::whole_state_v5_t::getHash()));
    const auto* body = reinterpret_cast<const std::byte*>(data) + 1;
    message.insert(message.end(), body, body + size - 1);
    const bool checked = (data[0] & 1) != 0 && message.size() >= check_at + check_size;
    if (checked) {
        put_big_endian(message, check_at, 0);
        std::uint64_t hash = 0xcbf29ce484222325;
        for (const auto byte : message) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3;
        put_big_endian(message, check_at, hash);
    }
    const auto head = head_of_whole_state(message);
    const auto state = read_whole_state(message);
    if (state && !head) std::abort();
    WholeStates states{head ? head->run : 1};
    states.receive(message, Instant{std::chrono::seconds{1}});
    states.receive(message, Instant{std::chrono::seconds{2}});
    const auto taken = states.take();
    if (taken && !state) std::abort();
    if (!head && (taken || states.refused() != 2)) std::abort();
    if (!state) return 0;
    if (state->axes.size() != static_cast<std::size_t>(state->axis_count)) std::abort();
    if (nlohmann::json::parse(state_json(*state), nullptr, false).is_discarded()) std::abort();
    std::vector<std::byte> buffer;
    const auto written = write_whole_state(*state, buffer);  // empty where a text has a NUL in it
    if (!written.empty() && !std::equal(written.begin(), written.end(), message.begin(), message.end())) std::abort();
    return 0;
}

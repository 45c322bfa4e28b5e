// Any bytes as a mailbox: header, CoE, SDO, emergency. Values that were read can be written and read again.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/sdo.hpp"

using namespace taktwerk::ecat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto message = parse_mailbox({reinterpret_cast<const std::byte*>(data), size});
    if (!message) return 0;
    (void)parse_mailbox_error(message->payload);
    if (const auto emergency = parse_emergency(message->payload)) {
        std::vector<std::byte> out(emergency_size);
        if (encode_emergency(out, *emergency) != emergency_size || parse_emergency(out) != emergency) std::abort();
    }
    const auto sdo = parse_sdo(message->payload);
    if (!sdo || sdo->kind != SdoKind::upload_response) return 0;
    std::vector<std::byte> out(sdo_initiate_size + sdo->data.size());
    const auto written = encode_upload_response(out, sdo->index, sdo->sub, sdo->data, sdo->complete_access);
    const auto again = parse_sdo(std::span<const std::byte>{out}.first(written));
    if (!again || again->index != sdo->index || !std::equal(again->data.begin(), again->data.end(), sdo->data.begin(), sdo->data.end()))
        std::abort();
    return 0;
}

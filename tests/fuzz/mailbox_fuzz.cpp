// Any bytes as a mailbox: header, CoE, SDO, SDO information, emergency. Values that were read can be written and read again.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/sdo.hpp"
#include "ecat/wire/sdo_info.hpp"

using namespace taktwerk::ecat;

namespace {

bool same(std::span<const std::byte> a, std::span<const std::byte> b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); }

void information(std::span<const std::byte> payload) {
    const auto info = parse_sdo_info(payload);
    if (!info) return;
    std::vector<std::byte> out(payload.size() + 16);
    const auto again = parse_sdo_info(std::span<const std::byte>{out}.first(encode_sdo_info(out, *info)));
    if (!again || again->opcode != info->opcode || again->incomplete != info->incomplete || again->fragments_left != info->fragments_left ||
        !same(again->data, info->data))
        std::abort();
    if (const auto list = parse_object_list(info->data)) {
        std::size_t sum = 0;
        for (std::size_t n = 0; n < list->size(); ++n) sum += (*list)[n];
        if (list->size() > 0 && sum > list->size() * 0xFFFFu) std::abort();
    }
    if (const auto object = parse_object_description(info->data))
        if (!same(std::span{out}.first(encode_object_description(out, *object)), info->data)) std::abort();
    if (const auto entry = parse_entry_description(info->data))
        if (!same(std::span{out}.first(encode_entry_description(out, *entry)), info->data)) std::abort();
    (void)parse_info_error(info->data);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto message = parse_mailbox({reinterpret_cast<const std::byte*>(data), size});
    if (!message) return 0;
    (void)parse_mailbox_error(message->payload);
    information(message->payload);
    if (const auto emergency = parse_emergency(message->payload)) {
        std::vector<std::byte> out(emergency_size);
        if (encode_emergency(out, *emergency) != emergency_size || parse_emergency(out) != emergency) std::abort();
    }
    const auto sdo = parse_sdo(message->payload);
    if (!sdo || sdo->kind != SdoKind::upload_response) return 0;
    std::vector<std::byte> out(sdo_initiate_size + sdo->data.size());
    const auto written = encode_upload_response(out, sdo->index, sdo->sub, sdo->data, sdo->complete_access);
    const auto again = parse_sdo(std::span<const std::byte>{out}.first(written));
    if (!again || again->index != sdo->index || !same(again->data, sdo->data)) std::abort();
    return 0;
}

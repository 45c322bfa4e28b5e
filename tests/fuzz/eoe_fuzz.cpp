// Any messages as EoE: fragments write back, what they are put together to is an Ethernet frame, and a simulated node answers with sound pieces.
// Input: messages [size, bytes], the size in units of two.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "ecat/eoe/frame_assembly.hpp"
#include "ecat/eoe/frame_cutter.hpp"
#include "ecat/sim/ethernet_node.hpp"
#include "ecat/wire/eoe.hpp"

using namespace taktwerk;
using namespace taktwerk::ecat;

namespace {

constexpr std::size_t mailbox = 128;

void settings_write_back(std::span<const std::byte> payload) {
    const auto settings = parse_eoe_set_ip(payload);
    if (!settings) return;
    std::vector<std::byte> out(eoe_set_ip_size);
    if (encode_eoe_set_ip(out, 0, *settings) != out.size()) std::abort();
    const auto again = parse_eoe_set_ip(out);
    if (!again || again->ip != settings->ip || again->mac != settings->mac || again->dns != settings->dns || again->name != settings->name)
        std::abort();
}

void fragment_writes_back(std::span<const std::byte> payload, const EoeFragment& fragment) {
    std::vector<std::byte> out(payload.size());
    if (encode_eoe_fragment(out, fragment) != payload.size()) std::abort();
    const auto again = parse_eoe_fragment(out);
    if (!again || again->number != fragment.number || again->blocks != fragment.blocks || again->frame != fragment.frame ||
        again->last != fragment.last || again->time != fragment.time || again->data.size() != fragment.data.size())
        std::abort();
}

void cuts_and_joins(std::span<const std::byte> frame) {
    FrameCutter cutter{frame, mailbox, 1};
    if (!cutter.possible()) std::abort();
    FrameAssembly assembly;
    std::optional<std::span<const std::byte>> whole;
    while (const auto piece = cutter.next()) whole = assembly.take(*piece);
    if (!whole || !std::equal(frame.begin(), frame.end(), whole->begin(), whole->end())) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FrameAssembly assembly;
    sim::EthernetOptions options;
    options.ip = 0x0A000001;
    sim::EthernetNode node{options};
    node.set_rooms(mailbox - 6, mailbox - 6);
    node.start();
    std::vector<std::byte> out(mailbox - 6);
    for (std::size_t at = 0, n = 0; at < size && n < 200; ++n) {
        const std::size_t length = std::min<std::size_t>(std::size_t{2} * data[at], size - at - 1);
        const std::span<const std::byte> payload{reinterpret_cast<const std::byte*>(data + at + 1), length};
        at += 1 + length;
        if (node.serve(payload, out, sim::EsmState::preop, Instant{}) > out.size()) std::abort();
        for (int pieces = 0; node.pending(); ++pieces)
            if (pieces >= eoe_most_fragments || !parse_eoe_fragment(std::span{out}.first(node.next(out)))) std::abort();
        settings_write_back(payload);
        (void)parse_eoe_result(payload, EoeType::set_ip_request);
        const auto fragment = parse_eoe_fragment(payload);
        if (!fragment) continue;
        fragment_writes_back(payload, *fragment);
        const auto frame = assembly.take(*fragment);
        if (!frame) continue;
        if (frame->size() < shortest_ethernet_frame || frame->size() > longest_ethernet_frame) std::abort();
        cuts_and_joins(*frame);
    }
    return 0;
}

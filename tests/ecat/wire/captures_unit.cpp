// Recorded traffic of other masters and real slaves: every datagram is understood and written again byte for byte.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/sdo.hpp"
#include "ecat/wire/sdo_info.hpp"
#include "tests/ecat/wire/bytes_of.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::ecat {
namespace {

using test::copy_of;

class Capture : public ::testing::TestWithParam<std::pair<const char*, std::size_t>> {};

bool is_ethercat(std::span<const std::byte> packet) {
    return packet.size() >= 16 && packet[12] == std::byte{0x88} && packet[13] == std::byte{0xA4};
}

/// Builds the frame anew from what was read; fields that only slaves write are carried over.
std::vector<std::byte> rebuilt(std::span<const std::byte> packet, std::size_t& datagrams) {
    MacAddress source{}, destination{};
    for (std::size_t i = 0; i < 6; ++i) {
        destination[i] = static_cast<std::uint8_t>(packet[i]);
        source[i] = static_cast<std::uint8_t>(packet[6 + i]);
    }
    std::array<std::byte, max_frame_size> buffer{};
    FrameBuilder builder{buffer, source, destination};
    FrameReader reader{packet};
    std::vector<Datagram> read;
    while (const auto datagram = reader.next()) {
        EXPECT_TRUE(builder.fits(datagram->data.size()));
        const auto data = builder.add(datagram->command, datagram->index, datagram->address, datagram->data.size());
        std::copy(datagram->data.begin(), datagram->data.end(), data.begin());
        read.push_back(*datagram);
    }
    EXPECT_EQ(reader.error(), FrameError::none);
    datagrams += read.size();

    auto frame = copy_of(builder.finish());
    FrameEditor editor{frame};
    for (const auto& datagram : read) {
        auto written = editor.next();
        if (!written) break;
        store_le<std::uint16_t>(written->header, 8, datagram.irq);
        store_le<std::uint16_t>(written->wkc, 0, datagram.working_counter());
    }
    return frame;
}

TEST_P(Capture, EveryDatagramParsesAndEncodesToTheSameBytes) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    const auto [file, expected_frames] = GetParam();
    const auto packets = test::read_pcapng(test::captures_folder() / file);
    std::size_t frames = 0, datagrams = 0;
    for (const auto& packet : packets) {
        if (!is_ethercat(packet)) continue;
        ++frames;
        auto frame = rebuilt(packet, datagrams);
        // Padding is not part of the protocol: compare what the length field covers.
        const std::size_t covered = 16 + (load_le<std::uint16_t>(packet, 14) & 0x07FFu);
        ASSERT_LE(covered, frame.size());
        frame.resize(covered);
        ASSERT_EQ(frame, copy_of(std::span{packet}.first(covered))) << "frame " << frames;
    }
    EXPECT_EQ(frames, expected_frames);
    EXPECT_GE(datagrams, frames);
}

// Numbers of EtherCAT frames as counted by tshark ("-Y ecat").
INSTANTIATE_TEST_SUITE_P(Files, Capture,
                         ::testing::Values(std::pair{"replay-dc.pcapng", std::size_t{3604}},
                                           std::pair{"replay-ek1100-el2828-el2889.pcapng", std::size_t{3578}},
                                           std::pair{"replay-ek1914-segmented-upload.pcapng", std::size_t{964}},
                                           std::pair{"soem-dual-lan9252.pcapng", std::size_t{1776}},
                                           std::pair{"soem-sdinfo-akd.pcapng", std::size_t{6759}}));

// An EK1914 answers 1008h:00, its device name.
TEST(CaptureSdo, RealSlavesAnswerIsUnderstood) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    std::size_t names = 0;
    for (const auto& packet : test::read_pcapng(test::captures_folder() / "replay-ek1914-segmented-upload.pcapng")) {
        FrameReader reader{packet};
        while (const auto datagram = reader.next()) {
            if (datagram->command != Command::FPRD || datagram->working_counter() != 1) continue;
            const auto mailbox = parse_mailbox(datagram->data);
            if (!mailbox || mailbox->header.type != MailboxType::coe) continue;
            const auto sdo = parse_sdo(mailbox->payload);
            if (!sdo || sdo->kind != SdoKind::upload_response || sdo->index != 0x1008) continue;
            EXPECT_EQ(copy_of(sdo->data), test::bytes_of("EK1914"));
            ++names;
        }
    }
    EXPECT_EQ(names, 1u);
}

// A servo drive answers 35 uploads, one after the other: each expedited, each to the object just asked for. (Named "sdinfo", but
// its master did not get to the SDO information service: no message of it is in the capture.)
TEST(CaptureSdo, EveryAnswerOfADriveBelongsToItsRequest) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    std::optional<SdoMessage> asked;
    std::size_t answered = 0, information = 0;
    for (const auto& packet : test::read_pcapng(test::captures_folder() / "soem-sdinfo-akd.pcapng")) {
        FrameReader reader{packet};
        while (const auto datagram = reader.next()) {
            // The mailboxes of this drive are 1024 bytes each, at 1800h and 1C00h.
            if (datagram->data.size() != 1024 || datagram->working_counter() != 1) continue;
            const auto mailbox = parse_mailbox(datagram->data);
            ASSERT_TRUE(mailbox);
            ASSERT_EQ(mailbox->header.type, MailboxType::coe);
            if (parse_sdo_info(mailbox->payload)) ++information;
            const auto sdo = parse_sdo(mailbox->payload);
            ASSERT_TRUE(sdo);
            if (datagram->command == Command::FPWR) {
                ASSERT_EQ(sdo->kind, SdoKind::upload_request);
                asked = sdo;
                asked->data = {};
            } else {
                ASSERT_EQ(sdo->kind, SdoKind::upload_response);
                ASSERT_TRUE(asked);
                EXPECT_EQ(sdo->index, asked->index);
                EXPECT_EQ(sdo->sub, asked->sub);
                EXPECT_TRUE(sdo->expedited);
                ++answered;
            }
        }
    }
    EXPECT_EQ(answered, 35u);
    EXPECT_EQ(information, 0u);
}

}  // namespace
}  // namespace taktwerk::ecat

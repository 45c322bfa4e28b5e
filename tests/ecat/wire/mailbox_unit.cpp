// Mailbox and SDO messages written by hand from ETG.1000.4 / ETG.1000.6; SDO command bytes as in CiA 301 (2Fh, 43h, 60h, ...).
#include "ecat/wire/mailbox.hpp"

#include <gtest/gtest.h>

#include <random>

#include "ecat/wire/sdo.hpp"
#include "tests/ecat/wire/bytes_of.hpp"

namespace taktwerk::ecat {
namespace {

using test::bytes_of;
using test::copy_of;

TEST(Mailbox, HeaderHasLengthAddressPriorityTypeAndCounter) {
    const MailboxHeader header{.length = 10, .address = 0x1001, .channel = 5, .priority = 2, .type = MailboxType::coe, .counter = 6};
    std::array<std::byte, mailbox_header_size> bytes{};

    encode(header, bytes);

    EXPECT_EQ(copy_of(bytes), bytes_of({0x0A, 0x00, 0x01, 0x10, 0x85, 0x63}));
    EXPECT_EQ(decode_mailbox_header(bytes), header);
}

TEST(Mailbox, CounterRunsFromOneToSevenAndNeverReturnsToZero) {
    EXPECT_EQ(next_mailbox_counter(0), 1);
    EXPECT_EQ(next_mailbox_counter(1), 2);
    EXPECT_EQ(next_mailbox_counter(7), 1);
}

TEST(Mailbox, FinishedMessageFillsTheWholeSyncManager) {
    std::vector<std::byte> mailbox(32, std::byte{0xEE});
    const auto size = encode_upload_request(std::span{mailbox}.subspan(mailbox_header_size), 0x1018, 1);

    ASSERT_TRUE(finish_mailbox(mailbox, MailboxType::coe, 1, size));

    auto expected = bytes_of({0x0A, 0x00, 0x00, 0x00, 0x00, 0x13, 0x00, 0x20, 0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0});
    expected.resize(32);
    EXPECT_EQ(mailbox, expected);
    EXPECT_FALSE(finish_mailbox(mailbox, MailboxType::coe, 1, 27));
}

TEST(Mailbox, LengthBeyondTheMailboxIsRefused) {
    EXPECT_FALSE(parse_mailbox(bytes_of({0x01, 0x00, 0, 0, 0})));
    EXPECT_FALSE(parse_mailbox(bytes_of({0x03, 0x00, 0, 0, 0, 0x13, 1, 2})));
    EXPECT_FALSE(parse_mailbox(bytes_of({0xFF, 0xFF, 0, 0, 0, 0x13, 1, 2})));
    const auto bytes = bytes_of({0x02, 0x00, 0, 0, 0, 0x13, 1, 2, 9, 9});
    const auto message = parse_mailbox(bytes);
    ASSERT_TRUE(message);
    EXPECT_EQ(copy_of(message->payload), bytes_of({1, 2}));
}

TEST(Mailbox, ErrorReplyCarriesItsDetail) {
    const auto bytes = bytes_of({0x04, 0x00, 0, 0, 0, 0x20, 0x01, 0x00, 0x07, 0x00});
    const auto message = parse_mailbox(bytes);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->header.type, MailboxType::error);
    EXPECT_EQ(parse_mailbox_error(message->payload), MailboxErrorDetail::no_more_memory);
    EXPECT_FALSE(parse_mailbox_error(message->payload.first(3)));

    std::array<std::byte, mailbox_error_size> payload{};
    encode_mailbox_error(payload, MailboxErrorDetail::unsupported_protocol);
    EXPECT_EQ(copy_of(payload), bytes_of({1, 0, 2, 0}));
}

class Sdo : public ::testing::Test {
protected:
    std::array<std::byte, 64> buffer{};
    std::vector<std::byte> written(std::size_t size) { return copy_of(std::span{buffer}.first(size)); }
};

TEST_F(Sdo, UploadRequest) {
    EXPECT_EQ(written(encode_upload_request(buffer, 0x6041, 0)), bytes_of({0x00, 0x20, 0x40, 0x41, 0x60, 0x00, 0, 0, 0, 0}));
    EXPECT_EQ(written(encode_upload_request(buffer, 0x1C12, 1, true)), bytes_of({0x00, 0x20, 0x50, 0x12, 0x1C, 0x01, 0, 0, 0, 0}));
}

// CiA 301: 4Fh, 4Bh, 47h, 43h for 1, 2, 3, 4 bytes.
TEST_F(Sdo, ExpeditedUploadResponseSaysHowManyBytesCount) {
    EXPECT_EQ(written(encode_upload_response(buffer, 0x6061, 0, bytes_of({8}))),
              bytes_of({0x00, 0x30, 0x4F, 0x61, 0x60, 0x00, 8, 0, 0, 0}));
    EXPECT_EQ(written(encode_upload_response(buffer, 0x6041, 0, bytes_of({0x37, 0x16}))),
              bytes_of({0x00, 0x30, 0x4B, 0x41, 0x60, 0x00, 0x37, 0x16, 0, 0}));
    EXPECT_EQ(written(encode_upload_response(buffer, 0x2000, 2, bytes_of({1, 2, 3})))[2], std::byte{0x47});
    const auto message = written(encode_upload_response(buffer, 0x1018, 1, bytes_of({0xFB, 0x07, 0, 0})));
    EXPECT_EQ(message, bytes_of({0x00, 0x30, 0x43, 0x18, 0x10, 0x01, 0xFB, 0x07, 0, 0}));

    const auto parsed = parse_sdo(message);
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->kind, SdoKind::upload_response);
    EXPECT_EQ(parsed->index, 0x1018);
    EXPECT_EQ(parsed->sub, 1);
    EXPECT_TRUE(parsed->expedited);
    EXPECT_EQ(parsed->complete_size, 4u);
    EXPECT_EQ(copy_of(parsed->data), bytes_of({0xFB, 0x07, 0, 0}));
}

// 2Fh, 2Bh, 23h for 1, 2, 4 bytes.
TEST_F(Sdo, ExpeditedDownload) {
    const auto message = written(encode_download_request(buffer, 0x6060, 0, bytes_of({8})));
    EXPECT_EQ(message, bytes_of({0x00, 0x20, 0x2F, 0x60, 0x60, 0x00, 8, 0, 0, 0}));
    const auto parsed = parse_sdo(message);
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->kind, SdoKind::download_request);
    EXPECT_EQ(copy_of(parsed->data), bytes_of({8}));

    EXPECT_EQ(written(encode_download_request(buffer, 0x1C12, 1, bytes_of({0x02, 0x17})))[2], std::byte{0x2B});
    EXPECT_EQ(written(encode_download_request(buffer, 0x6065, 0, bytes_of({1, 2, 3, 4})))[2], std::byte{0x23});
    const auto answer = written(encode_download_response(buffer, 0x6060, 0));
    EXPECT_EQ(answer, bytes_of({0x00, 0x30, 0x60, 0x60, 0x60, 0x00, 0, 0, 0, 0}));
    ASSERT_TRUE(parse_sdo(answer));
    EXPECT_EQ(parse_sdo(answer)->kind, SdoKind::download_response);
}

TEST_F(Sdo, LongerValueIsATransferWithItsSize) {
    const auto name = bytes_of("SV33-ECAT");
    const auto message = written(encode_upload_response(buffer, 0x1008, 0, name));
    auto expected = bytes_of({0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 9, 0, 0, 0});
    expected.insert(expected.end(), name.begin(), name.end());
    EXPECT_EQ(message, expected);

    auto padded = message;
    padded.resize(40, std::byte{0xEE});  // a slave that gives the length of its whole mailbox
    const auto parsed = parse_sdo(padded);
    ASSERT_TRUE(parsed);
    EXPECT_FALSE(parsed->expedited);
    EXPECT_EQ(parsed->complete_size, 9u);
    EXPECT_EQ(copy_of(parsed->data), name);
}

TEST_F(Sdo, ValueBeyondTheMailboxStartsASegmentedTransfer) {
    const std::vector<std::byte> value(100, std::byte{0x55});
    const auto size = encode_upload_response(std::span{buffer}.first(26), 0x1008, 0, value);
    EXPECT_EQ(size, 26u);
    const auto parsed = parse_sdo(written(size));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->complete_size, 100u);
    EXPECT_EQ(parsed->data.size(), 16u);
}

TEST_F(Sdo, SegmentsToggleAndTheLastSaysHowMuchIsUnused) {
    EXPECT_EQ(written(encode_upload_segment_request(buffer, false)), bytes_of({0x00, 0x20, 0x60, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(written(encode_upload_segment_request(buffer, true))[2], std::byte{0x70});

    // 3 of 7 bytes: unused 4 -> b3..1 = 4, toggle 10h, last 01h.
    const auto last = written(encode_upload_segment_response(buffer, true, true, bytes_of({1, 2, 3})));
    EXPECT_EQ(last, bytes_of({0x00, 0x30, 0x19, 1, 2, 3, 0, 0, 0, 0}));
    const auto parsed = parse_sdo(last);
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->kind, SdoKind::upload_segment_response);
    EXPECT_TRUE(parsed->toggle);
    EXPECT_TRUE(parsed->last);
    EXPECT_EQ(copy_of(parsed->data), bytes_of({1, 2, 3}));

    const auto first = written(encode_download_segment_request(buffer, false, false, bytes_of({1, 2, 3, 4, 5, 6, 7, 8})));
    EXPECT_EQ(first, bytes_of({0x00, 0x20, 0x00, 1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(parse_sdo(first)->data.size(), 8u);
    EXPECT_EQ(written(encode_download_segment_response(buffer, true)), bytes_of({0x00, 0x30, 0x30, 0, 0, 0, 0, 0, 0, 0}));
}

TEST_F(Sdo, AbortNamesObjectAndCode) {
    const auto message = written(encode_sdo_abort(buffer, 0x1C13, 2, sdo_abort::no_subindex));
    EXPECT_EQ(message, bytes_of({0x00, 0x20, 0x80, 0x13, 0x1C, 0x02, 0x11, 0x00, 0x09, 0x06}));
    auto answer = message;
    answer[1] = std::byte{0x30};  // slaves also send it as a response
    for (const auto& bytes : {message, answer}) {
        const auto parsed = parse_sdo(bytes);
        ASSERT_TRUE(parsed);
        EXPECT_EQ(parsed->kind, SdoKind::abort);
        EXPECT_EQ(parsed->index, 0x1C13);
        EXPECT_EQ(parsed->abort_code, 0x06090011u);
    }
    EXPECT_EQ(sdo_abort_text(0x06090011), "subindex does not exist");
    EXPECT_EQ(sdo_abort_text(0x12345678), "unknown abort code");
}

TEST_F(Sdo, AbortTextsCoverTheStandardsTable) {
    for (const auto code :
         {0x05030000u, 0x05040000u, 0x05040001u, 0x05040005u, 0x06010000u, 0x06010001u, 0x06010002u, 0x06010003u, 0x06010004u, 0x06010005u,
          0x06010006u, 0x06020000u, 0x06040041u, 0x06040042u, 0x06040043u, 0x06040047u, 0x06060000u, 0x06070010u, 0x06070012u, 0x06070013u,
          0x06090011u, 0x06090030u, 0x06090031u, 0x06090032u, 0x06090036u, 0x08000000u, 0x08000020u, 0x08000021u, 0x08000022u, 0x08000023u})
        EXPECT_NE(sdo_abort_text(code), "unknown abort code") << std::hex << code;
}

TEST_F(Sdo, TruncatedAndForeignMessagesAreRefused) {
    const auto good = written(encode_upload_response(buffer, 0x1018, 1, bytes_of({1, 2, 3, 4})));
    for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(parse_sdo(std::span{good}.first(size))) << size;
    EXPECT_FALSE(parse_sdo(bytes_of({0x00, 0x10, 0x43, 0, 0, 0, 0, 0, 0, 0}))) << "an emergency";
    EXPECT_FALSE(parse_sdo(bytes_of({0x00, 0x20, 0xE0, 0, 0, 0, 0, 0, 0, 0}))) << "command 7";
    EXPECT_EQ(encode_upload_request(std::span{buffer}.first(9), 0x1018, 1), 0u);
    EXPECT_EQ(encode_upload_segment_response(std::span{buffer}.first(9), false, true, {}), 0u);
}

TEST_F(Sdo, AnyBytesAreSafe) {
    std::mt19937 random{2};
    for (int i = 0; i < 50000; ++i) {
        std::vector<std::byte> bytes(random() % 24);
        for (auto& byte : bytes) byte = static_cast<std::byte>(random() & 0xFF);
        if (bytes.size() > 1) bytes[1] = static_cast<std::byte>(0x10u * (1 + random() % 3));
        if (const auto message = parse_sdo(bytes); message && !message->data.empty()) {
            EXPECT_GE(message->data.data(), bytes.data());
            EXPECT_LE(message->data.data() + message->data.size(), bytes.data() + bytes.size());
        }
        (void)parse_emergency(bytes);
    }
}

TEST_F(Sdo, EmergencyHasCodeRegisterAndFiveBytes) {
    const auto bytes = bytes_of({0x00, 0x10, 0x20, 0x73, 0x21, 1, 2, 3, 4, 5});
    const auto emergency = parse_emergency(bytes);
    ASSERT_TRUE(emergency);
    EXPECT_EQ(emergency->code, 0x7320);
    EXPECT_EQ(emergency->error_register, 0x21);
    EXPECT_EQ(emergency->data[4], std::byte{5});
    EXPECT_EQ(written(encode_emergency(buffer, *emergency)), bytes);
    EXPECT_FALSE(parse_emergency(std::span{bytes}.first(9)));
}

}  // namespace
}  // namespace taktwerk::ecat

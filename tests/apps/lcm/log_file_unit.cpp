// LCM's log format: byte for byte as its eventlog.h says, LCM's own library reads it, and a torn one is read as far as it goes.
#include "apps/lcm/log_file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>
#include <lcm/lcm-cpp.hpp>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "apps/lcm/split_log.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class LogFile : public ::testing::Test {
protected:
    LogFile() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-log-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~LogFile() override { fs::remove_all(folder_); }
    std::string path(const std::string& name = "run.lcmlog") const { return folder_ + "/" + name; }
    static std::vector<std::byte> bytes(std::string_view text) {
        std::vector<std::byte> out(text.size());
        std::memcpy(out.data(), text.data(), text.size());
        return out;
    }
    std::string content() const {
        std::ifstream in(path(), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void put(const std::string& text) const { std::ofstream(path(), std::ios::binary) << text; }
    std::vector<LoggedMessage> read(std::uint64_t skipped = 0) const {
        auto log = LogReader::open(path());
        EXPECT_TRUE(log) << log.error().text();
        std::vector<LoggedMessage> out;
        while (auto message = log->next()) out.push_back(std::move(*message));
        EXPECT_EQ(log->skipped(), skipped);
        return out;
    }
    void write_three() const {
        auto log = LogWriter::create(path());
        ASSERT_TRUE(log) << log.error().text();
        ASSERT_TRUE(log->write(1'764'109'646'125'000, "A", bytes("one")));
        ASSERT_TRUE(log->write(1'764'109'646'125'001, "CHANNEL", bytes("")));
        ASSERT_TRUE(log->write(1'764'109'646'125'002, "B", bytes("three")));
        ASSERT_TRUE(log->flush());
    }
    std::string folder_;
};

TEST_F(LogFile, HasTheHeaderOfLcm) {
    write_three();
    using namespace std::string_literals;
    // eventlog.h: sync, number, stamp (1764109646125000 = 64472C8CD57C8h), length of the channel, of the data.
    EXPECT_EQ(content().substr(0, 32),
              "\xED\xA1\xDA\x01"s + "\0\0\0\0\0\0\0\0"s + "\x00\x06\x44\x72\xC8\xCD\x57\xC8"s + "\0\0\0\x01"s + "\0\0\0\x03"s + "Aone"s);
    EXPECT_EQ(content().size(), 3 * 28u + 1 + 3 + 7 + 1 + 5);
}

TEST_F(LogFile, LcmReadsWhatWeWriteAndWeReadWhatLcmWrites) {
    write_three();
    lcm::LogFile theirs(path(), "r");
    ASSERT_TRUE(theirs.good());
    const auto* event = theirs.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->channel, "A");
    EXPECT_EQ(event->timestamp, 1'764'109'646'125'000);
    EXPECT_EQ(std::string(static_cast<const char*>(event->data), static_cast<std::size_t>(event->datalen)), "one");
    event = theirs.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, 1);
    event = theirs.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->channel, "B");

    fs::remove(path());
    {
        lcm::LogFile writes(path(), "w");
        lcm::LogEvent one{};
        one.timestamp = 77;
        one.channel = "THEIRS";
        char data[] = "abc";
        one.data = data;
        one.datalen = 3;
        ASSERT_EQ(writes.writeEvent(&one), 0);
    }
    const auto ours = read();
    ASSERT_EQ(ours.size(), 1u);
    EXPECT_EQ(ours[0].channel, "THEIRS");
    EXPECT_EQ(ours[0].utime, 77);
    EXPECT_EQ(ours[0].data, bytes("abc"));
}

TEST_F(LogFile, WhatIsThereIsNotWrittenOver) {
    put("precious");
    const auto refused = LogWriter::create(path());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, "lcm.log_exists");
    EXPECT_EQ(content(), "precious");
}

TEST_F(LogFile, ATornEndAndRubbishBetweenArePassedOver) {
    write_three();
    const auto whole = content();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        put(whole.substr(0, size));
        auto log = LogReader::open(path());
        ASSERT_TRUE(log);
        std::size_t messages = 0;
        while (log->next()) ++messages;
        EXPECT_EQ(messages, size < 32 ? 0u : size < 67 ? 1u : 2u) << size;
    }
    put("\xED rubbish \xED\xA1" + whole + std::string(100, '\xED') + whole);
    auto log = LogReader::open(path());
    ASSERT_TRUE(log);
    std::size_t messages = 0;
    while (log->next()) ++messages;
    EXPECT_EQ(messages, 6u);
    EXPECT_EQ(log->skipped(), 12u + 100u);
}

TEST_F(LogFile, LengthsThatLieTakeNoMemory) {
    write_three();
    auto lying = content();
    lying[24] = '\x0F';  // 251 million bytes of data in a file of 101
    put(lying);
    EXPECT_EQ(read(32).size(), 2u);
    lying[24] = '\xFF';
    put(lying);
    EXPECT_EQ(read(32).size(), 2u);
}

TEST_F(LogFile, OneFileEndsAtItsSizeAndSeveralKeepTheNewest) {
    auto one = SplitLog::create(path("one"), {100, 0});
    ASSERT_TRUE(one);
    EXPECT_EQ(*one->write(1, "A", bytes("0123456789")), SplitLog::Wrote::taken);
    EXPECT_EQ(*one->write(2, "A", bytes("0123456789")), SplitLog::Wrote::taken);
    EXPECT_EQ(*one->write(3, "A", bytes("0123456789")), SplitLog::Wrote::full);
    EXPECT_EQ(one->bytes(), 78u);

    auto several = SplitLog::create(path("several"), {100, 2});
    ASSERT_TRUE(several);
    for (int i = 0; i < 7; ++i) EXPECT_EQ(*several->write(i, "A", bytes("0123456789")), SplitLog::Wrote::taken);
    ASSERT_TRUE(several->flush());
    EXPECT_EQ(several->files(), 4);
    EXPECT_EQ(several->bytes(), 7 * 39u);
    EXPECT_FALSE(fs::exists(path("several.0001")));
    EXPECT_FALSE(fs::exists(path("several.0002")));
    EXPECT_EQ(fs::file_size(path("several.0003")), 78u);
    EXPECT_EQ(fs::file_size(path("several.0004")), 39u);
}

TEST_F(LogFile, AFileThatIsNoneIsSaid) {
    EXPECT_EQ(LogReader::open(path("missing")).error().code, "lcm.log_open");
    EXPECT_EQ(LogReader::open(folder_).error().code, "lcm.log_open");
    EXPECT_EQ(LogWriter::create(folder_ + "/no/folder").error().code, "lcm.log_open");
}

}  // namespace
}  // namespace taktwerk::apps

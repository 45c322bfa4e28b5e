#include "runtime/recording_file/recording_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string_view>

#include "core/bytes.hpp"
#include "core/crc32.hpp"

namespace taktwerk::runtime {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr RecordChannel beat = 0;

struct Record {
    RecordChannel channel = 0;
    std::int64_t time = 0;
    std::string bytes;
    friend bool operator==(const Record&, const Record&) = default;
};

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span{text.data(), text.size()}); }
RecordView view(const Record& r) { return {r.channel, Instant{Duration{r.time}}, bytes_of(r.bytes)}; }
Record copy_of(const RecordView& v) {
    return {v.channel, v.time.time_since_epoch().count(), {reinterpret_cast<const char*>(v.bytes.data()), v.bytes.size()}};
}

PackedBlock packed(std::span<const Record> records) {
    RecordPacker packer{beat};
    for (const auto& r : records) packer.add(view(r));
    return {packer.take(), records.size()};
}

/// All records of a source; what was read before an error stays.
std::vector<Record> all_of(RecordSource& source) {
    std::vector<Record> out;
    for (;;) {
        auto next = source.next();
        EXPECT_TRUE(next.ok()) << next.error().text();
        if (!next || !next->has_value()) return out;
        out.push_back(copy_of(**next));
    }
}

/// Cycles of a machine: a beat, a frame twice, now and then something rare; some of it moves.
std::vector<Record> cycles(std::size_t count, std::uint32_t seed) {
    std::mt19937 random{seed};
    std::vector<Record> out;
    std::string frame(60, '\0');
    for (std::size_t i = 0; i < count; ++i) {
        const auto time = static_cast<std::int64_t>(i) * 1'000'000;
        out.push_back({beat, time, std::string(20, static_cast<char>(i))});
        frame[10] = static_cast<char>(i);
        frame[30] = static_cast<char>(random());
        out.push_back({1, time + static_cast<std::int64_t>(random() % 1000), frame});
        out.push_back({1, time, std::string(60, 'x')});
        if (random() % 10 == 0) out.push_back({2, -time, std::string(random() % 300, static_cast<char>(random()))});
    }
    return out;
}

// --- blocks ---------------------------------------------------------------------------------------------------------------------------

TEST(RecordBlock, WhatWasPackedComesBackInItsOrder) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const auto records = cycles(1 + seed * 7, seed);
        const auto block = packed(records);

        UnpackedBlock back;
        ASSERT_TRUE(back.unpack(block.bytes, block.records, 3));
        ASSERT_EQ(back.size(), records.size());
        for (std::size_t i = 0; i < records.size(); ++i) ASSERT_EQ(copy_of(back.record(i)), records[i]) << i;
    }
}

TEST(RecordBlock, WhatRepeatsCostsNextToNothing) {
    std::vector<Record> records;
    for (std::int64_t i = 0; i < 1000; ++i) {
        records.push_back({beat, i * 1'000'000, std::string(20, 'a')});
        records.push_back({1, i * 1'000'000, std::string(300, 'b')});
    }
    EXPECT_LT(packed(records).bytes.size(), 1000u) << "of 336,000 bytes";
}

TEST(RecordBlock, ADamagedOneIsRefusedOrIsAnother) {
    const auto records = cycles(20, 5);
    const auto block = packed(records);
    UnpackedBlock back;
    EXPECT_FALSE(back.unpack(block.bytes, block.records + 1, 3)) << "it has not so many records";
    EXPECT_FALSE(back.unpack(block.bytes, block.records, 2)) << "there is no channel 2";
    EXPECT_FALSE(back.unpack({}, 0, 3));
    for (std::size_t length = 0; length < block.bytes.size(); ++length)
        ASSERT_FALSE(back.unpack(std::span{block.bytes}.first(length), block.records, 3)) << length;
}

TEST(RecordBlock, IsFullBeforeItsNumbersAreTooSmallForIt) {
    RecordPacker packer{beat};
    std::size_t added = 0;
    for (; !packer.full(); ++added) packer.add(view({1, 0, {}}));
    EXPECT_EQ(added, 60'000u);
    UnpackedBlock back;
    EXPECT_TRUE(back.unpack(packer.take(), added, 2));
    EXPECT_EQ(packer.records(), 0u);

    for (added = 0; !packer.full(); ++added) packer.add(view({1, 0, std::string(added, 'x')}));  // each another class
    EXPECT_TRUE(back.unpack(packer.take(), added, 2));
    EXPECT_EQ(back.size(), added);
}

// --- files ----------------------------------------------------------------------------------------------------------------------------

class RecordingFile : public testing::Test {
protected:
    RecordingFile() {
        auto pattern = testing::TempDir() + "taktwerk-recording-XXXXXX";
        folder = ::mkdtemp(pattern.data());
        path = folder + "/cell.twrec";
    }
    ~RecordingFile() override { fs::remove_all(folder); }

    std::vector<std::byte> file() const {
        std::ifstream in{path, std::ios::binary};
        const std::string all{std::istreambuf_iterator<char>{in}, {}};
        return {bytes_of(all).begin(), bytes_of(all).end()};
    }
    /// In blocks of `each` records.
    static Result<void> write(RecordingWriter& writer, const std::vector<Record>& records, std::size_t each) {
        for (std::size_t at = 0; at < records.size(); at += each)
            if (auto done = writer.write(packed(std::span{records}.subspan(at, std::min(each, records.size() - at)))); !done) return done;
        return {};
    }
    /// As a run of `blocks` blocks.
    void save(const std::vector<Record>& records, std::size_t each, RecordingRoom room = {}) {
        auto writer = RecordingWriter::create(path, info, room);
        ASSERT_TRUE(writer.ok()) << writer.error().text();
        ASSERT_TRUE(write(*writer, records, each).ok());
        ASSERT_TRUE(writer->finish(RecordingEnd::whole, 0).ok());
    }

    std::string folder, path;
    RecordingInfo info{{"beat", "inputs", "commands"}, {{"config", "sha256:00"}, {"binary", "0.1.0"}}};
};

TEST_F(RecordingFile, WhatWasSavedIsLoaded) {
    const auto records = cycles(300, 1);
    save(records, 64);

    const auto loaded = RecordingReader::open(path);

    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    EXPECT_EQ((*loaded)->info(), info);
    EXPECT_EQ((*loaded)->end(), RecordingEnd::whole);
    EXPECT_EQ((*loaded)->lost(), 0u);
    EXPECT_EQ((*loaded)->records(), records.size());
    EXPECT_EQ((*loaded)->bytes(), fs::file_size(path));
    EXPECT_EQ(all_of(**loaded), records);
}

TEST_F(RecordingFile, LossesAreInTheFile) {
    Recorder small{64, Recorder::Policy::overwrite_oldest};
    for (int i = 0; i < 7; ++i) small.append(0, Instant{Duration{i}}, bytes_of("x"));
    ASSERT_TRUE(save_recording(path, info, small, beat).ok());
    EXPECT_EQ((*RecordingReader::open(path))->lost(), 5u);  // two of 32 bytes are left
}

TEST_F(RecordingFile, CutOffAnywhereItLoadsUpToTheLastWholeBlockAndSaysThatItHasNoEnd) {
    const auto records = cycles(40, 2);
    save(records, 25);
    const auto whole = file();

    std::size_t last = records.size();
    bool began = false;
    for (std::size_t length = whole.size() - 1; length > 0; --length) {
        auto loaded = RecordingReader::of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}, "cut.twrec");
        if (!loaded.ok()) break;  // within the head
        began = true;
        ASSERT_EQ((*loaded)->end(), RecordingEnd::torn);
        const auto there = all_of(**loaded);
        ASSERT_TRUE(there.size() % 25 == 0 || there.size() == records.size()) << there.size();
        ASSERT_LE(there.size(), last);
        ASSERT_TRUE(std::equal(there.begin(), there.end(), records.begin()));
        last = there.size();
    }
    EXPECT_TRUE(began);
    EXPECT_EQ(last, 0u);
}

TEST_F(RecordingFile, AnyFlippedBitIsNoticed) {
    save(cycles(10, 3), 20);
    const auto whole = file();
    for (std::size_t i = 0; i < whole.size() * 8; ++i) {
        auto damaged = whole;
        damaged[i / 8] ^= std::byte{static_cast<unsigned char>(1u << (i % 8))};
        const auto loaded = RecordingReader::of(damaged, "damaged.twrec");
        // Nothing is left out as if it had been cut off: that looks so only where the end itself is damaged, behind which there is nothing.
        ASSERT_TRUE(!loaded.ok() || ((*loaded)->end() == RecordingEnd::torn && i / 8 >= whole.size() - 21)) << "bit " << i;
        if (loaded.ok()) {
            ASSERT_EQ(all_of(**loaded), cycles(10, 3)) << "bit " << i;
        }
    }
}

TEST_F(RecordingFile, PartsAreOneRecordingAndBounded) {
    const auto records = cycles(2000, 4);
    constexpr std::uint64_t part = 5000;
    save(records, 100, {part, 0});
    std::size_t parts = 0;
    for (std::size_t n = 1; fs::exists(part_path(path, n)); ++n) {
        ++parts;
        EXPECT_LE(fs::file_size(part_path(path, n)), part);
    }
    ASSERT_GT(parts, 3u);

    const auto loaded = RecordingReader::open(path);
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    EXPECT_EQ((*loaded)->parts(), parts);
    EXPECT_EQ((*loaded)->end(), RecordingEnd::whole);
    EXPECT_EQ(all_of(**loaded), records);

    EXPECT_EQ(RecordingReader::open(part_path(path, 2)).error().code, "recording.not_the_first");
    // One is missing: up to there, and it is said.
    fs::remove(part_path(path, 3));
    const auto short_one = RecordingReader::open(path);
    ASSERT_TRUE(short_one.ok());
    EXPECT_EQ((*short_one)->parts(), 2u);
    EXPECT_EQ((*short_one)->end(), RecordingEnd::no_part);
    const auto there = all_of(**short_one);
    EXPECT_GT(there.size(), 100u);
    EXPECT_TRUE(std::equal(there.begin(), there.end(), records.begin()));
    // What stands in its place and is of another recording is not taken for it.
    info.facts[0].second = "sha256:01";
    const auto of_this = path;
    path = folder + "/other.twrec";
    save(records, 100, {part, 0});
    fs::copy_file(part_path(path, 3), part_path(of_this, 3));
    const auto mixed = RecordingReader::open(of_this);
    ASSERT_TRUE(mixed.ok());
    EXPECT_EQ((*mixed)->end(), RecordingEnd::no_part);
}

TEST(RecordingParts, AreNamedBeforeTheEnding) {
    EXPECT_EQ(part_path("a.b/cell.twrec", 1), "a.b/cell.twrec");
    EXPECT_EQ(part_path("a.b/cell.twrec", 12), "a.b/cell.12.twrec");
    EXPECT_EQ(part_path("a.b/cell", 2), "a.b/cell.2");
    EXPECT_EQ(part_path(".cell", 2), ".cell.2");
}

TEST_F(RecordingFile, TheRoomOfAllPartsIsABound) {
    const auto records = cycles(2000, 6);
    for (const std::uint64_t part : {std::uint64_t{0}, std::uint64_t{4000}}) {
        auto writer = RecordingWriter::create(path, info, {part, 10'000});
        ASSERT_TRUE(writer.ok());
        const auto full = write(*writer, records, 50);
        ASSERT_FALSE(full.ok());
        EXPECT_EQ(full.error().code, "recording.limit");
        ASSERT_TRUE(writer->finish(RecordingEnd::limit, 0).ok());
        std::uint64_t bytes = 0;
        for (std::size_t n = 1; n <= writer->parts(); ++n) bytes += fs::file_size(part_path(path, n));
        EXPECT_LE(bytes, 10'000u);
        EXPECT_GT(bytes, 7'000u);

        const auto loaded = RecordingReader::open(path);
        ASSERT_TRUE(loaded.ok());
        EXPECT_EQ((*loaded)->end(), RecordingEnd::limit);
        const auto there = all_of(**loaded);
        EXPECT_TRUE(std::equal(there.begin(), there.end(), records.begin()));
        EXPECT_GT(there.size(), 100u);
    }
}

// The run goes on, and so does its file: the end that it had is no longer one.
TEST_F(RecordingFile, BehindAKeptEndItGoesOn) {
    const auto records = cycles(100, 7);
    const std::vector<Record> first{records.begin(), records.begin() + 60}, rest{records.begin() + 60, records.end()};
    auto writer = RecordingWriter::create(path, info);
    ASSERT_TRUE(writer.ok());
    ASSERT_TRUE(write(*writer, first, 30).ok());
    ASSERT_TRUE(writer->finish(RecordingEnd::kept, 0).ok());
    {
        const auto kept = RecordingReader::open(path);
        ASSERT_TRUE(kept.ok());
        EXPECT_EQ((*kept)->end(), RecordingEnd::kept);
        EXPECT_EQ(all_of(**kept), first);
    }
    ASSERT_TRUE(write(*writer, rest, 30).ok());
    ASSERT_TRUE(writer->finish(RecordingEnd::kept, 0).ok());
    EXPECT_EQ(all_of(**RecordingReader::open(path)), records);
}

TEST_F(RecordingFile, ErrorsNameTheFileAndWhatIsWrong) {
    EXPECT_EQ(RecordingReader::of({}, "empty.twrec").error().code, "recording.not_a_recording");
    EXPECT_THAT(RecordingReader::open("/nonexistent/a.twrec").error().text(), HasSubstr("/nonexistent/a.twrec"));
    EXPECT_EQ(RecordingReader::open(folder).error().code, "recording.read") << "a folder";
    EXPECT_EQ(RecordingWriter::create("/nonexistent/a.twrec", info).error().code, "recording.write");

    save(cycles(10, 8), 20);
    auto older = file();
    store_le(std::span{older}, 6, std::uint16_t{1});
    const auto refused = RecordingReader::of(older, "older.twrec");
    EXPECT_EQ(refused.error().code, "recording.version");
    EXPECT_THAT(refused.error().text(), HasSubstr("format 1 (not compressed)"));

    auto damaged = file();
    damaged[damaged.size() - 22] ^= std::byte{1};  // the last byte before the end, which has 21
    EXPECT_EQ(RecordingReader::of(damaged, "damaged.twrec").error().code, "recording.corrupt");
}

TEST_F(RecordingFile, AFullDiskIsAnError) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    EXPECT_EQ(RecordingWriter::create("/dev/full", info).error().code, "recording.write");
}

}  // namespace
}  // namespace taktwerk::runtime

// Files to and from a simulated slave through its mailbox, in virtual time.
#include "ecat/foe/file_transfer.hpp"

#include <gmock/gmock.h>

#include "ecat/wire/foe_error.hpp"
#include "tests/ecat/foe/foe_bench.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::size_t packet = 0x80 - 12;  // in PREOP

class FileSizes : public ::testing::TestWithParam<std::size_t> {};

// Around the edges of a packet: what fills one exactly ends with an empty one.
TEST_P(FileSizes, WhatIsWrittenIsReadBack) {
    FoeBench bench;
    const Bytes file = pattern(GetParam());

    const auto written = bench.write("log.txt", file);
    ASSERT_TRUE(written) << written.error().text();
    ASSERT_FALSE(written->failure) << written->failure->text();
    EXPECT_EQ(written->acknowledged, file.size());
    ASSERT_NE(bench.stored("log.txt"), nullptr);
    EXPECT_EQ(*bench.stored("log.txt"), file);

    const auto read = bench.read("log.txt");
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(*read, file);
}
INSTANTIATE_TEST_SUITE_P(Edges, FileSizes,
                         ::testing::Values(0u, 1u, packet - 1, packet, packet + 1, 2 * packet, 5 * packet + 3, std::size_t{100'000}));

TEST(FileTransfer, RefusalsHaveTheirCodeTheirWordsAndARemedy) {
    FoeBench bench;
    bench.slave->files()->plain() = {{"secret", pattern(10), 4711, false}, {"fixed", pattern(10), 0, true}};

    const auto missing = bench.read("nothing");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, "foe.refused");
    EXPECT_THAT(missing.error().what, AllOf(HasSubstr("reading file 'nothing' was refused"), HasSubstr("8001h file not found")));
    EXPECT_FALSE(missing.error().remedy.empty());
    EXPECT_EQ(foe_code(missing.error()), foe_error::not_found);

    EXPECT_EQ(foe_code(bench.read("secret").error()), foe_error::no_rights);
    EXPECT_EQ(foe_code(bench.read("secret", {}, 4712).error()), foe_error::no_rights);
    EXPECT_TRUE(bench.read("secret", {}, 4711));
    EXPECT_EQ(bench.refusal_of_write("secret", pattern(3)), foe_error::no_rights);
    EXPECT_EQ(bench.refusal_of_write("fixed", pattern(3)), foe_error::access_denied);
    EXPECT_EQ(bench.refusal_of_write("firmware", pattern(3)), foe_error::bootstrap_only);
    EXPECT_EQ(bench.refusal_of_write("large", pattern(300'000)), foe_error::disk_full);
    EXPECT_EQ(bench.stored("large"), nullptr) << "half a file is none";
    EXPECT_EQ(*bench.stored("fixed"), pattern(10));
}

TEST(FileTransfer, InBootThereIsFirmwareAndNothingElse) {
    FoeBench bench;
    bench.to_boot();
    EXPECT_EQ(bench.refusal_of_write("log.txt", pattern(3)), foe_error::not_bootstrap);
    const auto sdo = bench.upload(0x1000, 0);
    ASSERT_FALSE(sdo);
    EXPECT_THAT(sdo.error().what, HasSubstr("mailbox error 2"));
    const auto running = bench.read("firmware");
    ASSERT_TRUE(running) << running.error().text();
    EXPECT_TRUE(sim::read_firmware(*running)->sound);
}

TEST(FileTransfer, BusyIsWaitedForAndTold) {
    FoeBench bench;
    bench.to_boot();
    std::vector<FoeProgress> told;
    FoeSettings settings;
    settings.progress = [&](const FoeProgress& progress) { told.push_back(progress); };

    const Instant before = bench.now;
    const auto written = bench.write("firmware", bench.firmware("2.0", 2), settings);
    ASSERT_TRUE(written && !written->failure) << written->failure->text();

    EXPECT_GE(bench.now - before, bench.slave->options().firmware.erase_time);
    const auto busy = std::count_if(told.begin(), told.end(), [](const FoeProgress& p) { return p.busy; });
    EXPECT_GE(busy, 2);
    const auto first = std::find_if(told.begin(), told.end(), [](const FoeProgress& p) { return p.busy; });
    EXPECT_EQ(first->entire, 100);
    EXPECT_EQ(first->words, "flash");
    EXPECT_EQ(told.back().bytes, *told.back().of);
}

TEST(FileTransfer, BusyForEverEndsAndTheSlaveIsTold) {
    FoeBench bench;
    FoeSettings settings;
    settings.patience.busy = 3s;
    bench.slave->foe()->faults().stays_busy = true;
    const Instant before = bench.now;

    const auto written = bench.write("log.txt", pattern(500), settings);
    ASSERT_TRUE(written);
    ASSERT_TRUE(written->failure);
    EXPECT_EQ(written->failure->code, "foe.busy");
    EXPECT_NEAR(to_seconds(bench.now - before), 3.0, 0.2);

    bench.slave->foe()->faults().stays_busy = false;
    const auto again = bench.write("log.txt", pattern(500), settings);
    EXPECT_FALSE(again->failure) << "nothing of the first is left in its head";
}

TEST(FileTransfer, SilenceEndsAfterItsPatience) {
    FoeBench bench;
    FoeSettings settings;
    settings.patience.answer = 4s;
    bench.slave->foe()->faults().silent = 1;
    const Instant before = bench.now;
    const auto read = bench.read("log.txt", settings);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, "foe.timeout");
    EXPECT_NEAR(to_seconds(bench.now - before), 4.0, 0.1);
}

// A transfer that its master forgot: the usual slave stack ends it with "illegal" when the next request comes.
TEST(FileTransfer, ATransferThatWasLeftBehindDoesNotStandInTheWay) {
    FoeBench bench;
    bench.slave->files()->plain() = {{"old", pattern(1000), 0, false}};
    FoeSettings impatient;
    impatient.patience.answer = 1s;
    {
        // Left in the middle of its first packets.
        std::optional<Result<Bytes>> result;
        Runner runner{keep(read_file(*bench.port, bench.mailbox, {"old", 0}, impatient), result)};
        for (int i = 0; i < 12; ++i) {
            bench.step();
            runner.step(bench.now);
            bench.pack();
        }
        ASSERT_FALSE(result);
    }
    const auto read = bench.read("old");
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(*read, pattern(1000));
}

TEST(FileTransfer, AFileThatIsTooLargeIsNotReadToItsEnd) {
    FoeBench bench;
    bench.slave->files()->plain() = {{"long", pattern(5000), 0, false}};
    FoeSettings settings;
    settings.largest = 1000;
    const auto read = bench.read("long", settings);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, "foe.protocol");
    EXPECT_TRUE(bench.read("long")) << "the slave was told that it is over";
}

TEST(FileTransfer, AnErrorInTheMiddleSaysHowFarItCame) {
    FoeBench bench;
    bench.slave->foe()->faults().fails_at = 3;
    bench.slave->foe()->faults().fails_with = foe_error::flash_problem;
    const auto written = bench.write("log.txt", pattern(1000));
    ASSERT_TRUE(written && written->failure);
    EXPECT_EQ(foe_code(*written->failure), foe_error::flash_problem);
    EXPECT_EQ(written->acknowledged, 2 * packet);
    EXPECT_TRUE(written->begun);
}

TEST(FileTransfer, ANameHasToFit) {
    FoeBench bench;
    EXPECT_EQ(bench.read("").error().code, "foe.name");
    EXPECT_EQ(bench.read(std::string(packet + 1, 'x')).error().code, "foe.name");
    bench.mailbox.out_size = 12;
    EXPECT_EQ(bench.read("x").error().code, "foe.no_mailbox");
}

// A slave without FoE: mailbox error 2. Nothing of it was touched.
TEST(FileTransfer, ASlaveWithoutFilesSaysSo) {
    CoeBench bench{sim::small_drive()};
    const auto written = bench.run(write_file(*bench.port, bench.mailbox, {"x", 0}, pattern(10), {}));
    ASSERT_TRUE(written && written->failure);
    EXPECT_EQ(written->failure->code, "foe.mailbox");
    EXPECT_THAT(written->failure->what, HasSubstr("mailbox error 2"));
    EXPECT_FALSE(written->begun);
}

TEST(FileTransfer, ObjectsAreReadBetweenFiles) {
    FoeBench bench;
    EXPECT_FALSE(bench.write("a", pattern(300))->failure);
    EXPECT_TRUE(bench.upload(0x1000, 0));
    EXPECT_TRUE(bench.read("a"));
    EXPECT_TRUE(bench.upload(0x1000, 0));
}

}  // namespace
}  // namespace taktwerk::ecat::test

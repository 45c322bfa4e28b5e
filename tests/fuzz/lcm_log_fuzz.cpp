// Any bytes as a log of LCM: what is read lies in the file, and reading ends.
#include <cstdlib>

#include "apps/lcm/log_file.hpp"
#include "tests/fuzz/scratch_folder.hpp"

using namespace taktwerk::apps;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const taktwerk::fuzz::ScratchFolder folder;
    folder.write("log", {reinterpret_cast<const char*>(data), size});
    auto log = LogReader::open((folder.path() / "log").string());
    if (!log) std::abort();
    std::uint64_t read = 0;
    while (const auto message = log->next()) {
        if (message->channel.empty() || message->channel.size() > longest_channel) std::abort();
        read += log_header + message->channel.size() + message->data.size();
    }
    if (read + log->skipped() > size) std::abort();
    return 0;
}

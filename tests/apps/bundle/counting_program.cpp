// A program that knows on Monday how many pieces it has made; its second version counts scrap as well.

#include <cstdint>

#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;

class Counting final : public Program {
public:
    void declare(Declaration& d) override {
        d.task<&Counting::scan>("main");
        d.retain("pieces", pieces_);
#ifdef TAKTWERK_TEST_COUNTS_SCRAP
        d.retain("scrap", scrap_);
#endif
    }
    void scan(TaskContext&) {
        ++pieces_;
#ifdef TAKTWERK_TEST_COUNTS_SCRAP
        ++scrap_;
#endif
    }

private:
    std::int64_t pieces_ = 0;
#ifdef TAKTWERK_TEST_COUNTS_SCRAP
    std::int64_t scrap_ = 0;
#endif
};

}  // namespace

TAKTWERK_PROGRAM(Counting)

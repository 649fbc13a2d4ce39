#include "tests/run_tests.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "tests/seed.hpp"

namespace candela {
namespace {

bool chose_none = false;

/// Counts the test cases of a run. doctest calls it besides the reporter that prints.
class ChosenTests : public doctest::IReporter {
 public:
    explicit ChosenTests(const doctest::ContextOptions& /*options*/) {}

    void test_run_end(const doctest::TestRunStats& run) override {
        chose_none = run.numTestCasesPassingFilters == 0;
    }
    void report_query(const doctest::QueryData& /*query*/) override {}
    void test_run_start() override {}
    void test_case_start(const doctest::TestCaseData& /*test*/) override {}
    void test_case_reenter(const doctest::TestCaseData& /*test*/) override {}
    void test_case_end(const doctest::CurrentTestCaseStats& /*test*/) override {}
    void test_case_exception(const doctest::TestCaseException& /*exception*/) override {}
    void subcase_start(const doctest::SubcaseSignature& /*part*/) override {}
    void subcase_end() override {}
    void log_assert(const doctest::AssertData& /*assertion*/) override {}
    void log_message(const doctest::MessageData& /*message*/) override {}
    void test_case_skipped(const doctest::TestCaseData& /*test*/) override {}
};

REGISTER_LISTENER("chosen tests", 1, ChosenTests);

}  // namespace

int run_tests(int argc, const char* const* argv) {
    if (!take_test_seed()) return 2;
    const int status = doctest::Context(argc, argv).run();
    if (!chose_none) return status;
    fmt::print(stderr, "no test case was chosen\n");
    return EXIT_FAILURE;
}

}  // namespace candela

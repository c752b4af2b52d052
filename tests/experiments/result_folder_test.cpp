#include "experiments/runner/result_folder.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <set>

#include "tests/io/test_files.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ResultFolderTest : public TestFiles {
 protected:
  using Names = std::set<std::string>;

  /// All files below `out`, seen from there.
  Names names() const {
    Names names;
    for (const auto& entry : fs::recursive_directory_iterator(out_))
      if (!entry.is_directory()) names.insert(entry.path().lexically_relative(out_).string());
    return names;
  }

  std::string text_of(const std::string& name) const {
    const auto bytes = read_file((out_ / name).string());
    return {bytes.begin(), bytes.end()};
  }

  /// Begins a result whose files have `text` in them.
  std::unique_ptr<ResultFolder> begin(const ResultFolder::Files& files, const std::string& text,
                                      const ResultFolder::Files& inputs = {}) const {
    auto result = std::make_unique<ResultFolder>(out_, files, inputs);
    for (const auto& name : files) {
      fs::create_directories((result->unfinished() / name).parent_path());
      write_file((result->unfinished() / name).string(), {text.begin(), text.end()});
    }
    return result;
  }

  fs::path out_ = file("above/out");
};

TEST_F(ResultFolderTest, ChangesOnlyWhenItIsCommitted) {
  begin({"result.json", "a/one"}, "old")->commit();
  const auto fresh = begin({"result.json", "b/two"}, "new");
  EXPECT_EQ(text_of("result.json"), "old");
  EXPECT_EQ(text_of("a/one"), "old");
  EXPECT_FALSE(fs::exists(out_ / "b"));
  fresh->commit();
  EXPECT_EQ(names(), (Names{".pliant", "result.json", "b/two"}));
  EXPECT_EQ(text_of("result.json"), "new");
  EXPECT_FALSE(fs::exists(out_ / "a"));
}

TEST_F(ResultFolderTest, LeavesNothingWhenItFails) {
  begin({"result.json"}, "new").reset();
  EXPECT_FALSE(fs::exists(file("above"))) << "folders that were made for it go, too";
  begin({"result.json"}, "old")->commit();
  begin({"result.json", "more"}, "new").reset();
  EXPECT_EQ(names(), (Names{".pliant", "result.json"}));
  EXPECT_EQ(text_of("result.json"), "old");
}

TEST_F(ResultFolderTest, KeepsWhatWasFinishedWhereAskedTo) {
  begin({"result.json"}, "old")->commit();
  auto failing = begin({"result.json", "done", "half"}, "new");
  failing->keep();
  const fs::path kept = failing->unfinished();
  failing.reset();
  EXPECT_TRUE(fs::exists(kept / "done"));
  EXPECT_EQ(text_of("result.json"), "old");
  {
    ResultFolder next(out_, {"result.json", "done"}, {}, ResultFolder::Leftovers::stay);
    EXPECT_EQ(next.unfinished(), kept);
    next.keep_only({"done"});
    EXPECT_FALSE(fs::exists(kept / "half"));
  }
  EXPECT_TRUE(fs::exists(kept / "done")) << "it is kept until there is a result";
  begin({"result.json"}, "newest")->commit();
  EXPECT_EQ(names(), (Names{".pliant", "result.json"}));
}

TEST_F(ResultFolderTest, OneAtATimeIsWritten) {
  const auto first = begin({"result.json"}, "first");
  EXPECT_THAT(data_error_of([&] { begin({"result.json"}, "second"); }),
              HasSubstr("another process is writing a result here"));
  first->commit();
  EXPECT_EQ(text_of("result.json"), "first");
  begin({"result.json"}, "second")->commit();
  EXPECT_EQ(text_of("result.json"), "second");
}

TEST_F(ResultFolderTest, AFolderOfOthersWithTheNameOfTheUnfinishedOneStays) {
  fs::create_directories(out_ / "unfinished");
  write("above/out/unfinished/thesis.tex", "mine");
  EXPECT_THAT(data_error_of([&] { begin({"result.json"}, "new"); }),
              HasSubstr("unfinished is not of an earlier result"));
  EXPECT_EQ(names(), (Names{"unfinished/thesis.tex"}));
}

TEST_F(ResultFolderTest, FilesOfOthersStay) {
  begin({"result.json", "a/one"}, "old")->commit();
  write("above/out/notes", "mine");
  write("above/out/a/notes", "mine");
  begin({"result.json"}, "new")->commit();
  EXPECT_EQ(names(), (Names{".pliant", "result.json", "notes", "a/notes"}));
}

TEST_F(ResultFolderTest, AListThatWasEditedLeadsNowhereElse) {
  begin({"result.json", "a/one"}, "old")->commit();
  const std::string mine = file("above/mine");
  write("above/mine", "mine");
  write("above/out/.pliant", "result.json\na/one\n../mine\na/../../mine\n" + mine + "\n");
  begin({"result.json"}, "new")->commit();
  EXPECT_EQ(names(), (Names{".pliant", "result.json"}));
  EXPECT_TRUE(fs::exists(mine));
}

TEST_F(ResultFolderTest, RefusesToReplaceWhatIsNotOfAnEarlierResult) {
  fs::create_directories(out_ / "folder.png");
  write("above/out/notes", "mine");
  write("above/out/picture.png", "mine");
  fs::create_symlink("nowhere", out_ / "link.png");
  const auto message = data_error_of([&] {
    begin({"result.json", "picture.png", "folder.png", "link.png", "notes/below"}, "new");
  });
  for (const char* name : {"picture.png", "folder.png", "link.png", "notes"})
    EXPECT_THAT(message, HasSubstr((out_ / name).string() + " is not of an earlier result"));
  EXPECT_THAT(message, Not(HasSubstr("result.json")));
  EXPECT_EQ(names(), (Names{"notes", "picture.png", "link.png"}));
}

TEST_F(ResultFolderTest, RefusesToReplaceWhatIsReadThoughItIsOfAnEarlierResult) {
  begin({"result.json", "experiment.yaml"}, "old")->commit();
  fs::create_directory_symlink(out_, file("other_way"));
  EXPECT_THAT(data_error_of([&] {
                begin({"result.json", "experiment.yaml"}, "new", {file("other_way/experiment.yaml")});
              }),
              AllOf(HasSubstr("experiment.yaml is read by this experiment"), Not(HasSubstr("result.json"))));
  EXPECT_EQ(text_of("experiment.yaml"), "old");
}

TEST_F(ResultFolderTest, AFileThatCameInTheMeantimeIsNotReplacedAndTheNewResultIsKept) {
  const auto fresh = begin({"result.json"}, "new");
  write("above/out/result.json", "mine");
  EXPECT_THAT(data_error_of([&] { fresh->commit(); }), HasSubstr("the new result is kept in "));
  EXPECT_EQ(text_of("result.json"), "mine");
  EXPECT_EQ(names(), (Names{"result.json", "unfinished/.pliant", "unfinished/result.json"}));
}

TEST_F(ResultFolderTest, ResultsInsideAResultAreReplacedWithIt) {
  begin({"result.json"}, "old")->commit();
  {
    ResultFolder outer(file("whole"), {"inner/result.json"}, {});
    ResultFolder inner(outer.unfinished() / "inner", {"result.json"}, {});
    write_file((inner.unfinished() / "result.json").string(), {1});
    inner.commit();
    outer.commit();
  }
  {
    ResultFolder inner(file("whole/inner"), {"result.json", "later"}, {});
    write_file((inner.unfinished() / "later").string(), {1});
    inner.commit();
  }
  ResultFolder outer(file("whole"), {"inner/later"}, {});
  outer.commit();
  EXPECT_FALSE(fs::exists(file("whole/inner")));
}

TEST_F(ResultFolderTest, TheFolderItselfStays) {
  fs::create_directories(out_);
  fs::permissions(out_, fs::perms::owner_all);
  const fs::path before = fs::current_path();
  fs::current_path(out_);
  {
    ResultFolder result(".", {"result.json"}, {});
    write_file((result.unfinished() / "result.json").string(), {1});
    result.commit();
  }
  EXPECT_TRUE(fs::exists("result.json"));
  fs::current_path(before);
  EXPECT_EQ(fs::status(out_).permissions(), fs::perms::owner_all);
}

}  // namespace
}  // namespace pliant::test

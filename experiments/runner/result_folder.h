#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pliant {

/// Whether a path that should be of a file in a result's folder may be of one elsewhere, as in a list that
/// someone has edited.
bool leads_out(const std::filesystem::path& file);

/// A folder that holds one result, the old or the new one, and may hold other files as well. A result is
/// written into its folder `unfinished`, by one process at a time; commit() puts it in the old one's place by
/// renaming. What belongs to a result is listed in its file `.pliant`; nothing else is ever replaced or
/// removed.
///
/// The folder itself stays: it may be somebody's current folder, a mount point, or have other rights than its
/// parent. Between the first and the last rename (a millisecond) result.json is not there.
class ResultFolder {
 public:
  using Files = std::vector<std::filesystem::path>;
  /// What becomes of a result that was begun here and not finished.
  enum class Leftovers { go, stay };

  /// Makes `folder` unless it is there. `files`: all that may be written, relative to it; `inputs`: what must
  /// not be replaced although an earlier result has it. Throws DataError that names each file in the way, or
  /// why the folder cannot be made or written, or that another process writes it.
  ResultFolder(const std::filesystem::path& folder, const Files& files, const Files& inputs,
               Leftovers leftovers = Leftovers::go);
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;
  /// Unless there was a commit() or keep(), nothing is left of what was begun.
  ~ResultFolder();

  /// Where the result is written.
  const std::filesystem::path& unfinished() const { return unfinished_; }

  /// Removes from unfinished() all but these files and folders in it, which stay as if by keep().
  void keep_only(const Files& names);

  /// From now on what was written stays beside the old result, whatever ends this, until commit().
  void keep();

  /// Puts the new result in the place of the old one.
  void commit();

  /// Makes one more file of the result in `folder`, which the next result replaces like its others. `name`:
  /// relative to the folder. Throws DataError when it cannot be written.
  static void add(const std::filesystem::path& folder, const std::filesystem::path& name,
                  const std::string& text);

  /// For a process that is about to be ended from another thread: waits for a commit() that is under way,
  /// removes what other folders have begun, and lets no thread begin or commit any more. Gives the places of
  /// what is kept.
  static Files abandon_all();

 private:
  void check_free(const Files& files, const Files& inputs) const;
  void open();
  void lock();
  void clear_but(const Files& names);
  void abandon();
  void replace_by(Files fresh) const;

  std::filesystem::path folder_;
  std::filesystem::path topmost_made_;  ///< of the folders that had to be made; empty: none
  std::filesystem::path unfinished_;    ///< empty when it is no more
  int lock_ = -1;                       ///< of the open folder `unfinished_`
  bool is_kept_ = false;
};

}  // namespace pliant

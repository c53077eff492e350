// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_OUTPUT_FILE_H
#define OPENSUBDIVHEX_TUTORIALS_OUTPUT_FILE_H

#include <cstdio>
#include <string>
#include <string_view>

namespace OpenSubdivHex::Tutorials {

/// \brief A file that appears whole or not at all.
///
/// Content goes to a temporary file that Commit() puts in the place of the target; without Commit()
/// it is removed and the target stays as it was.  On Linux it has no name before Commit(), so that
/// nothing is left of a process that is killed; elsewhere, and on disks that know no such files, it
/// lies beside the target.  A target that is no regular file, such as /dev/null, is written
/// directly.  All functions throw FileError.
class OutputFile {
public:
    explicit OutputFile(std::string const &path);
    ~OutputFile();

    OutputFile(OutputFile const &) = delete;
    OutputFile &operator=(OutputFile const &) = delete;

    /// Writes at once: contents should be large.
    void Write(std::string_view content);

    void Commit();

private:
    [[noreturn]] void refuse() const;

    std::string _path;          ///< as given, for messages
    std::string _targetPath;    ///< links resolved
    std::string _temporaryPath; ///< of a temporary file while it has a name
    bool _isUnnamed = false;    ///< a temporary file that gets its name from Commit
    std::FILE *_file = nullptr;
};

} // namespace OpenSubdivHex::Tutorials

#endif

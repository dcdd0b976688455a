// cli/openvdb_helper.cpp - implements the program `halflight-openvdb IN.vdb OUT.nvdb`, which converts an OpenVDB file to
// a NanoVDB file.
//
// The library and `halflight` do not link OpenVDB. They run this program as a child process, with limits. Tiles and
// leaves are copied as they are. Content that no NanoVDB grid can hold is left out, with a message.
#define NANOVDB_USE_OPENVDB
#include <openvdb/openvdb.h>

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <cstdio>
#include <exception>
#include <vector>

namespace {

using Handle = nanovdb::GridHandle<nanovdb::HostBuffer>;

// Converts a grid if NanoVDB has a kind for it. Other grids, such as points, are left out, with a message.
void convert(openvdb::GridBase::Ptr grid, const std::string &name, std::vector<Handle> &made) {
  try {
    made.push_back(nanovdb::openToNanoVDB(grid));
  } catch (const std::exception &error) {
    std::fprintf(stderr, "grid \"%s\" is passed over: %s\n", name.c_str(), error.what());
  }
}

}  // namespace

int main(int count, char **words) {
  if (count != 3) {
    std::fprintf(stderr, "usage: halflight-openvdb IN.vdb OUT.nvdb\n");
    return 2;
  }
  try {
    openvdb::initialize();
    openvdb::io::File file(words[1]);
    file.open(false);  // no delayed loading: the file is read once
    std::vector<Handle> made;
    for (auto name = file.beginName(); name != file.endName(); ++name)
      convert(file.readGrid(name.gridName()), name.gridName(), made);
    file.close();
    if (made.empty()) {
      std::fprintf(stderr, "no grid in it can be converted\n");
      return 1;
    }
    nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(words[2], made, nanovdb::io::Codec::NONE);
    return 0;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

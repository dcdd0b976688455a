// cli/openvdb_helper.cpp - halflight-openvdb IN.vdb OUT.nvdb: an OpenVDB file as a NanoVDB file.
//
// A program of its own: the library and `halflight` link nothing of OpenVDB and run this one as a child, with limits.
// Tiles and leaves are handed over as they are; what no NanoVDB grid can hold is passed over with a word.
#define NANOVDB_USE_OPENVDB
#include <openvdb/openvdb.h>

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <cstdio>
#include <exception>
#include <vector>

namespace {

using Handle = nanovdb::GridHandle<nanovdb::HostBuffer>;

// Converts one grid that NanoVDB has a kind for; others, such as points, are passed over with a word.
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

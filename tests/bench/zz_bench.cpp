#include "core/document/codec.h"
#include "core/edit/split_merge.h"
#include "core/mesh/mesh_validate.h"
#include "core/mesh/jacobian.h"
#include "core/edit/deformation.h"
#include <glm/geometric.hpp>
#include <cstdio>
using namespace tessera;
int main(){
  auto d=loadDocument("/tmp/edit/kodim23.tessera");
  PatchMesh mesh=d->mesh; size_t ok=0,no=0,f=0;
  std::printf("joins %zu\n",mesh.smoothJoins().size());
  size_t smooth=0,two=0;
  mesh.forEachVertex([&](VertexId v){ std::vector<EdgeId> fs; mesh.connectivity().forEachOutgoing(v,[&](HalfedgeId h){if(mesh.curve(HalfedgeMesh::edge(h)).feature)fs.push_back(HalfedgeMesh::edge(h));}); if(fs.size()==2){++two; smooth+=isSmooth(mesh,{v,fs[0],fs[1]});
    }});
  std::printf("two %zu smooth %zu\n",two,smooth);
  for(uint32_t e=0;e<1000;e+=3){ PatchMesh m=mesh; bool s=splitEdge(m,EdgeId(e),.5).has_value(); (s?ok:no)++; if(!s&&mesh.curve(EdgeId(e)).feature)++f; }
  std::printf("split ok %zu no %zu (features %zu)\n",ok,no,f);
}

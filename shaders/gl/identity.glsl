#pragma once
// Which triangle a fragment belongs to: identityOf(instanceIdentity, triangleNumber) is its name.
layout(location = 4) flat in uint triangleNumber;  // within the primitive
uniform uint instanceIdentity;

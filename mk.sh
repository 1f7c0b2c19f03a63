W=/work/wt/fuzz; B=$W/build/${3:-release-asserts}
g++ -std=c++20 -O1 -g -DRESECT_VERIFY -ffp-contract=off -I$W/include -I$W/src -I$W -I$W/tests $1 -o $2 $B/libresect_fuzz.a $B/libresect.a -lfmt -lpugixml -lpthread

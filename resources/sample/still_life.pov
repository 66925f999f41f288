// still_life.pov - a studio still life for POV-Ray 3.7
// Part of the Tessera project (Apache-2.0).  Units: centimetres.  y is up.
#version 3.7;
#include "functions.inc"

#ifndef (Fast) #declare Fast = 0; #end      // Declare=Fast=1 or 2: quick previews

global_settings {
  assumed_gamma 1.0
  max_trace_level 8
  radiosity {
    pretrace_start 0.08 pretrace_end 0.02
    count #if (Fast) 40 #else 60 #end
    nearest_count 6 error_bound #if (Fast) 1.2 #else 1.1 #end
    recursion_limit 2 low_error_factor 0.6 gray_threshold 0.15
    minimum_reuse 0.02 brightness 1.0
  }
}
#default { finish { ambient 0 diffuse 0.75 } }

// ------------------------------------------------------------------ camera
camera {
  location <1.5, 25.5, -92>
  right x*4/3 up y
  angle 37
  look_at <0.8, 9.6, 0>
  #if (Fast < 2)
    aperture 2.1
    focal_point <0, 4, -7>
    #if (Fast) blur_samples 4, 12 confidence 0.8 variance 1/200
    #else blur_samples 8, 26 confidence 0.9 variance 1/400 #end
  #end
}

// ------------------------------------------------------------------ light
light_source {
  <-78, 66, -42> srgb <1.00, 0.965, 0.92>*1.80
  area_light <28, 0, -46>, <0, 54, 0>, 3, 3
  adaptive 0 jitter
  fade_distance 104 fade_power 2
}
// the window itself: seen only in reflections
#declare Pane = box { <-1,-1,0>, <1,1,0.01>
  pigment { srgb <1, 0.97, 0.93> }
  finish { ambient 0 diffuse 0 emission 3.2 }
}
union {
  #local I = 0;
  #while (I < 6)
    object { Pane scale <12.2, 13, 1> translate <(mod(I,2)-0.5)*27, (int(I/2)-1)*29, 0> }
    #local I = I + 1;
  #end
  rotate y*-60
  translate <-92, 60, -48>
  no_image no_shadow no_radiosity
}
// a pale card on the other side, again only for the reflections
box { <-26, -22, 0>, <26, 22, 0.1>
  pigment { srgb 1 } finish { ambient 0 diffuse 0 emission 0.42 }
  rotate y*52 translate <78, 34, -62>
  no_image no_shadow no_radiosity
}
// room seen in reflections, and the soft fill
sky_sphere {
  pigment {
    function { 0.5 - 0.42*x + 0.16*y - 0.10*z }
    color_map {
      [0.00 srgb <0.16, 0.145, 0.135>]
      [0.45 srgb <0.30, 0.285, 0.275>]
      [0.75 srgb <0.53, 0.525, 0.525>]
      [1.00 srgb <0.70, 0.71, 0.73>]
    }
  }
}

// ------------------------------------------------------------------ wall
plane { -z, -72
  pigment {
    function { f_noise3d(x*0.035, y*0.035, 3)*0.65 + f_noise3d(x*0.13, y*0.13, 7)*0.35 }
    color_map {
      [0.25 srgb <0.545, 0.53, 0.50>]
      [0.75 srgb <0.60, 0.585, 0.555>]
    }
  }
}

// ------------------------------------------------------------------ table
#declare FWarp = function(x,y,z) { z + 1.6*f_noise3d(x*0.035, y*0.3, z*0.16) + 0.35*f_noise3d(x*0.11, y, z*0.5) }
#declare FRing = function(x,y,z) {    // growth rings cut lengthwise, sharper on one side
  pow(mod(1.15*sqrt(y*y*1.5 + pow(FWarp(x,y,z),2)) + 40, 1), 1.7)
}
#declare FFibre = function(x,y,z) { 0.5*f_noise3d(x*0.16, y*3, z*6) + 0.5*f_noise3d(x*0.5, y*8, z*17) }
#declare FPore = function(x,y,z) { f_noise3d(x*1.1, y*12, z*15) }
#macro WoodTex(Dark, Off)
  texture {
    pigment {
      function { min(0.999, max(0, 0.26*FRing(x,y,z) + 0.46*FFibre(x,y,z) + 0.34*f_noise3d(x*0.05, y*0.4, z*0.35))) }
      color_map {
        [0.25 srgb <0.48, 0.315, 0.19>*Dark]
        [0.45 srgb <0.415, 0.26, 0.15>*Dark]
        [0.62 srgb <0.345, 0.205, 0.118>*Dark]
        [0.85 srgb <0.25, 0.145, 0.085>*Dark]
      }
      translate Off
    }
    normal { function { 0.6*FFibre(x,y,z) + 0.4*FPore(x,y,z) + 0.010*f_noise3d(x*60,y*60,z*60) } 0.09 translate Off }
    finish { diffuse 0.74 specular 0.10 roughness 0.05
             reflection { 0.004, 0.20 fresnel on } conserve_energy }
  }
  texture {
    pigment {
      function { FPore(x,y,z) + 0.10*FRing(x,y,z) }
      color_map {
        [0.26 srgb <0.12, 0.065, 0.035> transmit 0.45]
        [0.36 srgb <0.12, 0.065, 0.035> transmit 1]
      }
      translate Off
    }
    finish { diffuse 0.7 }
  }
#end
#declare RS = seed(41);
union {
  #local Z = -110;
  #while (Z < 110)
    #local W = 10.5 + 4*rand(RS);
    #local Off = <rand(RS)*80, 3 + rand(RS)*6, (rand(RS)-0.5)*14>;
    union {
      box { <-32, -3, 0.12>, <70, 0, W-0.12> }
      box { <-32, -3, 0.02>, <70, -0.1, W-0.02> }
      cylinder { <-32, -0.1, 0.12>, <70, -0.1, 0.12>, 0.1 }
      cylinder { <-32, -0.1, W-0.12>, <70, -0.1, W-0.12>, 0.1 }
      WoodTex(0.88 + 0.24*rand(RS), Off)
      interior { ior 1.5 }
      translate <0, 0, Z>
    }
    #local Z = Z + W;
  #end
  box { <-31.5, -4, -110>, <70, -1.2, 110> pigment { srgb <0.05,0.03,0.02> } }
  rotate y*94
}

// ------------------------------------------------------------------ meshes of revolution
// Spl(t) = <radius, height> for t = 0 (outer bottom) .. 1 (top);
// Lobe: five soft lobes near the bottom; Ecc: irregularity; Bend: leaning of the upper part
#declare SStep = function(a,b,v) { min(1,max(0,(v-a)/(b-a)))*min(1,max(0,(v-a)/(b-a)))*(3-2*min(1,max(0,(v-a)/(b-a)))) }
#macro Rev(Spl, N, M, Lobe, Ecc, Sd, Bend)
  #local P = array[N+1][M];
  #local I = 0;
  #while (I <= N)
    #local Q = Spl(I/N);
    #local R0 = max(0, Q.x);
    #if (I = 0 | I = N) #local R0 = 0; #end
    #local J = 0;
    #while (J < M)
      #local A = 2*pi*J/M;
      #local K = 1
        + Lobe*(1 - SStep(-0.75, 0.25, Q.y))*cos(5*A + Sd)
        + Lobe*0.4*SStep(0.3, 0.9, Q.y)*cos(5*A + Sd + 0.5)
        + Ecc*2*(f_noise3d(cos(A)*0.8 + Sd*3.1, Q.y*0.8 + Sd, sin(A)*0.8) - 0.5);
      #local Tilt = Ecc*0.7*R0*cos(A + Sd*2);
      #local P[I][J] = <R0*K*cos(A) + Bend*pow(max(0,Q.y),2), Q.y + Tilt*0.5, R0*K*sin(A)>;
      #local J = J + 1;
    #end
    #local I = I + 1;
  #end
  mesh2 {
    vertex_vectors { (N+1)*M
      #local I = 0; #while (I <= N) #local J = 0; #while (J < M) , P[I][J] #local J = J + 1; #end #local I = I + 1; #end
    }
    normal_vectors { (N+1)*M
      #local I = 0;
      #while (I <= N)
        #local J = 0;
        #while (J < M)
          #if (I = 0) , -y #else #if (I = N) , y #else
            #local Nn = vcross(P[I+1][J] - P[I-1][J], P[I][mod(J+1,M)] - P[I][mod(J+M-1,M)]);
            #if (vlength(Nn) < 1e-12) #local Nn = y; #end
            , vnormalize(Nn)
          #end #end
          #local J = J + 1;
        #end
        #local I = I + 1;
      #end
    }
    face_indices { 2*N*M
      #local I = 0;
      #while (I < N)
        #local J = 0;
        #while (J < M)
          #local J2 = mod(J+1, M);
          , <I*M+J, (I+1)*M+J, (I+1)*M+J2>, <I*M+J, (I+1)*M+J2, I*M+J2>
          #local J = J + 1;
        #end
        #local I = I + 1;
      #end
    }
    inside_vector y
  }
#end

// ------------------------------------------------------------------ apple
#declare AppleSpl = spline { natural_spline
  0.00, <0.00, -0.66, 0>  0.07, <0.16, -0.74, 0>  0.14, <0.36, -0.83, 0>
  0.23, <0.62, -0.74, 0>  0.35, <0.86, -0.42, 0>  0.48, <0.995, 0.06, 0>
  0.60, <0.94, 0.47, 0>   0.70, <0.74, 0.75, 0>   0.79, <0.49, 0.845, 0>
  0.87, <0.26, 0.76, 0>   0.94, <0.10, 0.58, 0>   1.00, <0.00, 0.46, 0>
}
#declare AppleV = function(x,y,z,s,rd,bx,bz) {
  0.46 + rd + 0.26*(x*bx + z*bz) + 0.10*y
  + 0.40*(f_noise3d(7*x/(sqrt(x*x+z*z)+0.03)+s, 0.9*y+s, 7*z/(sqrt(x*x+z*z)+0.03)) - 0.5)
  + 0.30*(f_noise3d(19*x/(sqrt(x*x+z*z)+0.03)+s, 1.6*y, 19*z/(sqrt(x*x+z*z)+0.03)+s) - 0.5)
  + 0.62*(f_noise3d(1.5*x+s, 1.5*y, 1.5*z+s) - 0.5) + 0.16*(f_noise3d(7*x+s, 7*y, 7*z) - 0.5)
  - 0.85*exp(-(x*x+z*z)/0.05)
}
#macro AppleTex(S, Red, BX, BZ)
  texture {
    pigment {
      function { min(0.999, max(0, AppleV(x,y,z,S,Red,BX,BZ))) }
      color_map {
        [0.00 srgb <0.60, 0.62, 0.22>]
        [0.22 srgb <0.78, 0.68, 0.27>]
        [0.40 srgb <0.80, 0.44, 0.20>]
        [0.58 srgb <0.70, 0.17, 0.12>]
        [0.80 srgb <0.56, 0.07, 0.075>]
        [1.00 srgb <0.36, 0.035, 0.05>]
      }
    }
  }
  texture {     // lenticels
    pigment {
      crackle form <1,0,0> metric 2
      color_map {
        [0.00 srgb <0.90, 0.76, 0.50> transmit 0.35]
        [0.06 srgb <0.90, 0.76, 0.50> transmit 0.60]
        [0.12 srgb <0.90, 0.76, 0.50> transmit 1]
      }
      scale 0.088 translate S
    }
    normal { average normal_map { [1 bumps 0.07 scale 0.09] [1 bumps 0.26 scale 0.011] } }
    finish { diffuse 0.75 specular 0.16 roughness 0.025
             reflection { 0.004, 0.22 fresnel on } conserve_energy }
  }
#end
#macro Stem(Len, Lean, Base)
  sphere_sweep { b_spline 6,
    <0, Base-0.10, 0>, 0.042  <0, Base-0.02, 0>, 0.042
    <Lean*0.12, Base+Len*0.35, Lean*0.05>, 0.032
    <Lean*0.36, Base+Len*0.7, Lean*0.12>, 0.036
    <Lean*0.72, Base+Len, Lean*0.15>, 0.062
    <Lean*0.95, Base+Len*1.15, Lean*0.15>, 0.065
    tolerance 1e-4
    texture {
      pigment { bozo color_map { [0.3 srgb <0.24,0.16,0.08>] [0.7 srgb <0.42,0.33,0.17>] } scale 0.12 }
      normal { bumps 0.4 scale 0.04 }
      finish { diffuse 0.75 specular 0.05 }
    }
  }
#end
#declare NR = (Fast ? 36 : 64);
#macro Apple(S, Red, BX, BZ, Lean)
  union {
    object { Rev(AppleSpl, NR, NR*2, 0.035, 0.05, S, 0)
      AppleTex(S*7.3, Red, BX, BZ) interior { ior 1.42 } }
    Stem(0.52, Lean, 0.48)
    // the dried calyx at the other end
    #local I = 0;
    #while (I < 5)
      cone { <0.03,-0.66,0>, 0.05, <0.10,-0.79,0.03>, 0.005 rotate y*72*I
        pigment { srgb <0.22,0.17,0.10> } }
      #local I = I + 1;
    #end
  }
#end

// ------------------------------------------------------------------ pear
#declare PearSpl = spline { natural_spline
  0.00, <0.00, -0.86, 0>  0.06, <0.14, -0.90, 0>  0.13, <0.36, -0.95, 0>
  0.23, <0.70, -0.80, 0>  0.34, <0.94, -0.42, 0>  0.45, <0.99, 0.02, 0>
  0.56, <0.84, 0.46, 0>   0.66, <0.61, 0.86, 0>   0.76, <0.455, 1.22, 0>
  0.85, <0.37, 1.52, 0>   0.93, <0.22, 1.72, 0>   0.97, <0.10, 1.75, 0>  1.00, <0.00, 1.72, 0>
}
#macro PearTex(S, Blush, BX, BZ)
  texture {
    pigment {
      function { min(0.999, max(0, 0.36 + Blush*(x*BX + z*BZ) + 0.10*(y-0.3)
        + 0.50*(f_noise3d(1.3*x+S, 1.3*y, 1.3*z) - 0.5) + 0.22*(f_noise3d(5*x+S, 5*y, 5*z) - 0.5))) }
      color_map {
        [0.00 srgb <0.47, 0.53, 0.19>]
        [0.35 srgb <0.66, 0.66, 0.26>]
        [0.60 srgb <0.78, 0.67, 0.29>]
        [0.80 srgb <0.78, 0.48, 0.22>]
        [1.00 srgb <0.66, 0.26, 0.15>]
      }
    }
  }
  texture {     // russet patches near the stem and the calyx
    pigment {
      function { min(0.999, max(0, 1.2*SStep(1.15, 1.85, y) + 0.9*SStep(-0.5, -1.0, y)
        + 1.1*(f_noise3d(4*x+S, 4*y, 4*z) - 0.5) - 0.05)) }
      color_map {
        [0.25 srgb <0.50, 0.36, 0.17> transmit 1]
        [0.70 srgb <0.50, 0.36, 0.17> transmit 0.45]
        [1.00 srgb <0.45, 0.32, 0.15> transmit 0.2]
      }
    }
  }
  texture {
    pigment {
      crackle form <1,0,0>
      color_map {
        [0.00 srgb <0.38, 0.30, 0.13> transmit 0.15]
        [0.11 srgb <0.38, 0.30, 0.13> transmit 0.5]
        [0.20 srgb <0.38, 0.30, 0.13> transmit 1]
      }
      scale 0.075 translate S
    }
    normal { bumps 0.08 scale 0.06 }
    finish { diffuse 0.75 specular 0.14 roughness 0.04
             reflection { 0.005, 0.25 fresnel on } conserve_energy }
  }
#end
#macro Pear(S, Blush, BX, BZ, Bend, Lean)
  union {
    object { Rev(PearSpl, NR*1.25, NR*2, 0.022, 0.06, S, Bend)
      PearTex(S*5.7, Blush, BX, BZ) interior { ior 1.40 } }
    object { Stem(0.55, Lean, 0) translate <Bend*1.73*1.73, 1.71, 0> }
  }
#end

// ------------------------------------------------------------------ orange
#declare OrangeSpl = spline { natural_spline
  0.00, <0.00, -0.90, 0>  0.05, <0.13, -0.915, 0> 0.12, <0.33, -0.895, 0>
  0.25, <0.69, -0.69, 0>  0.38, <0.935, -0.33, 0> 0.50, <1.0, 0.06, 0>
  0.62, <0.92, 0.44, 0>   0.75, <0.66, 0.75, 0>   0.86, <0.37, 0.905, 0>
  0.93, <0.18, 0.925, 0>  0.97, <0.08, 0.885, 0>  1.00, <0.00, 0.87, 0>
}
#macro Orange(S, Hue)
  union {
    object { Rev(OrangeSpl, NR, NR*2, 0.006, 0.035, S, 0)
      texture {
        pigment {
          function { min(0.999, max(0, Hue + 0.55*(f_noise3d(1.7*x+S*9, 1.7*y, 1.7*z) - 0.5)
            + 0.25*(f_noise3d(9*x+S, 9*y, 9*z) - 0.5) - 0.5*exp(-(x*x+z*z)/0.012)*SStep(0,0.5,y))) }
          color_map {
            [0.00 srgb <0.72, 0.52, 0.16>]
            [0.25 srgb <0.88, 0.53, 0.11>]
            [0.55 srgb <0.90, 0.43, 0.07>]
            [0.85 srgb <0.86, 0.33, 0.055>]
            [1.00 srgb <0.76, 0.26, 0.05>]
          }
        }
        normal {
          average normal_map {
            [1.0 crackle 0.9 form <1,0,0> scale 0.062
              slope_map { [0 <0,1>] [0.25 <0.6,1>] [0.5 <1,0>] [1 <1,0>] } ]
            [0.7 bumps 0.28 scale 0.05]
            [0.4 bumps 0.15 scale 0.3]
          }
        }
        finish { diffuse 0.75 specular 0.17 roughness 0.03
                 reflection { 0.01, 0.25 fresnel on } conserve_energy }
      }
      interior { ior 1.45 }
    }
    #local I = 0;
    #while (I < 5)
      sphere { 0, 1 scale <0.075, 0.022, 0.04> translate <0.06, 0.89, 0> rotate y*(72*I + S*50)
        pigment { srgb <0.30, 0.34, 0.13> } }
      #local I = I + 1;
    #end
    sphere { 0, 1 scale <0.05, 0.03, 0.05> translate <0, 0.90, 0> pigment { srgb <0.36, 0.30, 0.16> } }
  }
#end

// ------------------------------------------------------------------ grapes
#declare FBloom = function(x,y,z) { 0.6*f_noise3d(x*2.2,y*2.2,z*2.2) + 0.4*f_noise3d(x*8,y*8,z*8) }
#macro GrapeTex(T, S)
  texture {
    pigment {
      function { min(0.999, max(0, T + 0.5*(f_noise3d(x*1.4+S, y*1.4, z*1.4) - 0.5))) }
      color_map {
        [0.0 srgb <0.13, 0.035, 0.085>]
        [0.4 srgb <0.23, 0.05, 0.115>]
        [0.7 srgb <0.36, 0.08, 0.13>]
        [1.0 srgb <0.47, 0.17, 0.15>]
      }
    }
    finish { diffuse 0.8 emission 0.02 }
  }
  texture {
    pigment {
      function { min(0.999, max(0, FBloom(x+S, y+S*1.7, z) + 0.16*y)) }
      color_map {
        [0.38 srgb <0.52, 0.50, 0.60> transmit 0.97]
        [0.75 srgb <0.56, 0.54, 0.63> transmit 0.68]
      }
    }
    normal { bumps 0.03 scale 0.3 }
    finish { diffuse 0.7 specular 0.22 roughness 0.02
             reflection { 0.015, 0.45 fresnel on } conserve_energy }
  }
#end
#macro Grape(Pos, R, S, T)
  sphere { 0, 1
    GrapeTex(T, S)
    interior { ior 1.42 }
    scale <1, 1.1 + 0.1*rand(RG), 1> * R
    rotate <rand(RG)*70 - 35, rand(RG)*360, rand(RG)*70 - 35>
    translate Pos
  }
#end
// Drops spheres one by one into an ellipse, each into the lowest of a few places tried.
#macro GrapePile(CX, CZ, AX, AZ, Rot, Count, Floor, Sd)
  #declare RG = seed(Sd);
  #local GP = array[Count];
  #local GR = array[Count];
  #local C = 0;
  #while (C < Count)
    #local R = 0.92 + 0.20*rand(RG);
    #local BestY = 1e6;
    #local Shrink = 1 - 0.42*C/Count;
    #local Try = 0;
    #while (Try < 26)
      #local A = rand(RG)*2*pi;
      #local Q = sqrt(rand(RG))*Shrink;
      #local V = vrotate(<AX*Q*cos(A), 0, AZ*Q*sin(A)*(0.78 + 0.30*Q*cos(A))>, y*Rot) + <CX, 0, CZ>;
      #local Y = Floor + R;
      #local K = 0;
      #while (K < C)
        #local DX = V.x - GP[K].x; #local DZ = V.z - GP[K].z;
        #local D2 = pow(0.97*(R + GR[K]), 2) - DX*DX - DZ*DZ;
        #if (D2 > 0) #local Y = max(Y, GP[K].y + sqrt(D2)); #end
        #local K = K + 1;
      #end
      #if (Y < BestY) #local BestY = Y; #local BestP = <V.x, Y, V.z>; #end
      #local Try = Try + 1;
    #end
    #local GP[C] = BestP;
    #local GR[C] = R;
    Grape(BestP, R, C*3.17, 0.10 + 0.75*pow(rand(RG), 1.6))
    #local C = C + 1;
  #end
#end

// ------------------------------------------------------------------ vase
#declare VaseSpl = spline { natural_spline
  0.00, <0.0, 0.25, 0>   0.04, <2.6, 0.22, 0>  0.07, <3.9, 0.0, 0>   0.085, <4.15, 0.25, 0>
  0.11, <4.3, 1.0, 0>    0.18, <5.6, 3.6, 0>   0.27, <7.1, 7.2, 0>   0.36, <7.75, 11.0, 0>
  0.44, <7.1, 14.9, 0>   0.51, <5.3, 17.9, 0>  0.57, <3.55, 20.0, 0> 0.62, <2.65, 22.0, 0>
  0.67, <2.55, 24.0, 0>  0.72, <3.05, 25.8, 0> 0.76, <3.85, 26.9, 0> 0.775, <4.05, 27.15, 0>
  0.79, <4.0, 27.35, 0>  0.81, <3.75, 27.3, 0> 0.85, <2.75, 25.8, 0> 0.89, <2.15, 23.8, 0>
  0.93, <2.2, 21.8, 0>   0.97, <1.9, 20.3, 0>  1.00, <0.0, 20.0, 0>
}
#declare FDrip = function(x,y,z) { y
  + 1.5*(f_noise3d(x*0.32+4, 1, z*0.32) - 0.5) + 3.4*pow(f_noise3d(x*0.75+9, y*0.06, z*0.75), 2) }
#declare Vase = object {
  Rev(VaseSpl, 150, 120, 0, 0.006, 2, 0)
  texture {
    pigment {
      function { min(0.999, max(0, FDrip(x,y,z)/30)) }
      color_map {
        [0.000 srgb <0.56, 0.45, 0.34>]
        [0.165 srgb <0.60, 0.48, 0.36>]
        [0.172 srgb <0.30, 0.26, 0.20>]
        [0.185 srgb <0.16, 0.27, 0.27>]
        [0.23  srgb <0.15, 0.34, 0.35>]
        [0.45  srgb <0.20, 0.43, 0.43>]
        [0.62  srgb <0.34, 0.54, 0.51>]
        [0.80  srgb <0.27, 0.48, 0.47>]
        [0.925 srgb <0.40, 0.55, 0.50>]
        [0.955 srgb <0.50, 0.46, 0.36>]
      }
    }
  }
  texture {   // iron specks and cloudy glaze
    pigment {
      function { 0.55*f_noise3d(x*0.5,y*0.35,z*0.5) + 0.45*f_noise3d(x*2.6,y*1.4,z*2.6) }
      color_map {
        [0.30 srgb <0.09, 0.20, 0.22> transmit 0.55]
        [0.50 srgb <0.2, 0.4, 0.4> transmit 1]
        [0.72 srgb <0.62, 0.74, 0.68> transmit 0.72]
      }
    }
  }
  texture {
    pigment {
      crackle form <1,0,0>
      color_map {
        [0.06 srgb <0.16, 0.11, 0.07> transmit 0.2]
        [0.11 srgb <0.16, 0.11, 0.07> transmit 1]
      }
      scale 0.62 turbulence 0.2
    }
    normal {
      average normal_map {
        [1 function { 0.5 + 0.5*sin(y*5.2 + 1.5*f_noise3d(x*0.3,y*0.8,z*0.3)) } 0.09]
        [1 bumps 0.05 scale 1.2]
      }
    }
    finish { diffuse 0.78 specular 0.2 roughness 0.008
             reflection { 0.02, 0.75 fresnel on } conserve_energy }
  }
  interior { ior 1.55 }
}

// ------------------------------------------------------------------ hammered brass bowl
#declare BowlSpl = spline { natural_spline
  0.00, <0.0, 0.15, 0>   0.06, <3.2, 0.12, 0>  0.09, <4.3, 0.0, 0>   0.11, <4.6, 0.15, 0>
  0.14, <4.75, 0.7, 0>   0.20, <6.4, 1.7, 0>   0.28, <8.6, 3.5, 0>   0.37, <10.2, 5.8, 0>
  0.45, <11.1, 7.9, 0>   0.48, <11.5, 8.35, 0> 0.495, <11.6, 8.55, 0> 0.51, <11.45, 8.68, 0>
  0.53, <11.2, 8.55, 0>  0.56, <10.8, 7.9, 0>  0.65, <9.8, 5.8, 0>   0.76, <8.2, 3.7, 0>
  0.87, <5.6, 1.8, 0>    0.95, <2.6, 1.0, 0>   1.00, <0.0, 0.95, 0>
}
#declare FHam = function { pattern { crackle form <1,0,0> } }
#declare Bowl = object {
  Rev(BowlSpl, 130, 150, 0, 0.006, 5, 0)
  texture {
    pigment {
      function { 0.6*f_noise3d(x*0.35,y*0.35,z*0.35) + 0.4*f_noise3d(x*1.8,y*1.8,z*1.8) }
      color_map {
        [0.25 srgb <0.78, 0.60, 0.36>]
        [0.75 srgb <0.88, 0.72, 0.46>]
      }
    }
    normal { function { pow(FHam(x*0.62,y*0.62,z*0.62),2)*1.9 + 0.03*f_noise3d(x*4,y*4,z*4) } 0.55 }
    finish { diffuse 0.20 specular 0.5 roughness 0.03 metallic
             reflection { 0.78 metallic } brilliance 1.5 }
  }
}

// ------------------------------------------------------------------ cloth
// places where something rests: x, z, radius of the flat spot
#declare NFlat = 6;
#declare Flat = array[NFlat] {
  <8, 4.0, 5.2>, <-6.3, -10.0, 2.4>, <13.8, -9.8, 6.4>, <-0.2, -7.0, 2.4>, <2.6, -13.6, 3.6>, <24.6, 9.5, 3.4>
}
// folds: start x, z, direction (deg), length; width, height, lean, curvature
#declare NFold = 12;
#declare Fold = array[NFold][8] {
  {  3.5,-17.5, 256, 20,  1.5, 2.3,  0.9,  0.010 },
  {  7.5,-17.0, 274, 17,  1.2, 1.7, -0.7, -0.012 },
  { -2.0,-14.0, 236, 17,  1.6, 1.9,  0.8, -0.014 },
  { 17.0,-15.0, 300, 18,  1.6, 2.2,  0.8,  0.012 },
  { 11.0,-18.5, 280, 14,  1.0, 1.2,  0.5,  0.010 },
  { 19.5, -6.0, 345, 18,  1.7, 2.6,  0.9,  0.016 },
  { 20.0, -9.0, 326, 18,  1.3, 1.7,  0.7, -0.010 },
  { 19.0,  2.0,   8, 18,  1.8, 2.8,  0.8, -0.010 },
  { 17.5,  8.5,  30, 16,  1.5, 2.2,  0.7,  0.010 },
  { -3.0, -3.0, 190, 16,  1.3, 1.7,  0.6,  0.014 },
  { -3.2, -6.0, 208, 12,  1.0, 1.1,  0.5, -0.010 },
  { -2.0,  4.0, 165, 11,  1.3, 1.6,  0.6, -0.014 }
}
#declare CU0 = -11; #declare CU1 = 35; #declare CV0 = -30; #declare CV1 = 15;  // size, before turning
#macro ClothPos(U, V)
  // a gently wavy, turned rectangle
  #local X = U + 0.9*sin(V*0.17 + 1) + 0.35*sin(V*0.43);
  #local Z = V + 0.8*sin(U*0.15) + 0.35*sin(U*0.37 + 2);
  #local Pt = vrotate(<X-12, 0, Z+8>, y*14) + <11.2, 0, -8>;
  #local W = 1;
  #local K = 0;
  #while (K < NFlat)
    #local D = vlength(<Pt.x - Flat[K].x, 0, Pt.z - Flat[K].y>);
    #local W = W*SStep(Flat[K].z - 0.6, Flat[K].z + 2.6, D);
    #local K = K + 1;
  #end
  #local H = 0.16 + W*(0.30*f_noise3d(Pt.x*0.16, 2, Pt.z*0.16) + 0.28*f_noise3d(Pt.x*0.45, 5, Pt.z*0.45));
  #local S = <0,0,0>;
  #local K = 0;
  #while (K < NFold)
    #local Dr = <cos(radians(Fold[K][2])), 0, sin(radians(Fold[K][2]))>;
    #local Pp = <-Dr.z, 0, Dr.x>;
    #local Rl = Pt - <Fold[K][0], 0, Fold[K][1]>;
    #local A = vdot(Rl, Dr);
    #if (A > -3 & A < Fold[K][3] + 6)
      #local B = vdot(Rl, Pp) + Fold[K][7]*A*A + 0.5*sin(A*0.35 + K*2);
      #local Wd = Fold[K][4]*(0.8 + 0.035*max(0,A));
      #if (abs(B) < Wd*4)
        #local Amp = Fold[K][5]*SStep(-2.5, 5, A)*(1 - 0.75*SStep(Fold[K][3]*0.45, Fold[K][3]+5, A));
        #if (A > Fold[K][3]) #local Amp = Amp*(1 - SStep(Fold[K][3], Fold[K][3]+6, A)); #end
        #local Bs = B/Wd; 
        #local G = (Bs > 0 ? exp(-Bs*Bs*1.9) : exp(-Bs*Bs*0.7));
        #local H = H + Amp*G*W;
        #local S = S + Pp*Fold[K][6]*Amp*G*W*0.40;
      #end
    #end
    #local K = K + 1;
  #end
  (Pt + S + y*H)
#end
#local St = (Fast ? 0.40 : 0.26);
#local NU = int((CU1-CU0)/St); #local NV = int((CV1-CV0)/St);
#local CP = array[NU+3][NV+3];
#local I = 0;
#while (I < NU+3)
  #local J = 0;
  #while (J < NV+3)
    // the outermost ring of vertices is tucked down to the table
    #local CI = min(max(I,1),NU+1); #local CJ = min(max(J,1),NV+1);
    #local Pq = ClothPos(CU0 + (CI-1)*St, CV0 + (CJ-1)*St);
    #local Edge = (I=0 | J=0 | I=NU+2 | J=NV+2);
    #local CP[I][J] = <Pq.x, (Edge ? max(-0.02, Pq.y-0.32) : Pq.y), Pq.z>;
    #local J = J + 1;
  #end
  #local I = I + 1;
#end
// plain weave with slubs; u and v are centimetres of cloth
#declare Pitch = 0.23;
#declare FSu = function(u,v) { sin(pi*(u + 0.09*f_noise3d(u*0.5, v*0.35, 1))/Pitch) }
#declare FSv = function(u,v) { sin(pi*(v + 0.09*f_noise3d(u*0.35, v*0.5, 9))/Pitch) }
#declare FWeave = function(u,v) {
  select(FSu(u,v)*FSv(u,v),
    pow(abs(FSu(u,v)),0.7)*(0.55 + 0.45*abs(FSv(u,v)))*(0.72 + 0.56*f_noise3d(u*2.6, v*0.25, 4)),
    pow(abs(FSv(u,v)),0.7)*(0.55 + 0.45*abs(FSu(u,v)))*(0.72 + 0.56*f_noise3d(u*0.25, v*2.6, 6)))
}
#declare FBand = function(v) { select(abs(v)-1.5, 1, select(abs(abs(v)-2.3)-0.3, 1, 0)) }
mesh2 {
  vertex_vectors { (NU+3)*(NV+3)
    #local I = 0; #while (I < NU+3) #local J = 0; #while (J < NV+3) , CP[I][J] #local J = J + 1; #end #local I = I + 1; #end
  }
  normal_vectors { (NU+3)*(NV+3)
    #local I = 0;
    #while (I < NU+3)
      #local J = 0;
      #while (J < NV+3)
        #local Nn = vcross(CP[min(I+1,NU+2)][J] - CP[max(I-1,0)][J], CP[I][min(J+1,NV+2)] - CP[I][max(J-1,0)]);
        #if (vlength(Nn) < 1e-9) #local Nn = -y; #end
        , vnormalize(-Nn)
        #local J = J + 1;
      #end
      #local I = I + 1;
    #end
  }
  uv_vectors { (NU+3)*(NV+3)
    #local I = 0;
    #while (I < NU+3) #local J = 0;
      #while (J < NV+3) , <CU0 + (I-1)*St, CV0 + (J-1)*St> #local J = J + 1; #end
      #local I = I + 1;
    #end
  }
  face_indices { 2*(NU+2)*(NV+2)
    #local I = 0;
    #while (I < NU+2)
      #local J = 0;
      #while (J < NV+2)
        #local A = I*(NV+3)+J; #local B = A + NV+3;
        , <A, B, B+1>, <A, B+1, A+1>
        #local J = J + 1;
      #end
      #local I = I + 1;
    #end
  }
  uv_mapping
  texture {
    uv_mapping
    pigment {
      pigment_pattern {
        function { max(FBand(y+24.5), FBand(x+5.5)*0.999) }
      }
      pigment_map {
        [0.5 function { FWeave(x,y) }
          color_map {
            [0.00 srgb <0.50, 0.465, 0.41>]
            [0.28 srgb <0.67, 0.635, 0.575>]
            [1.00 srgb <0.84, 0.81, 0.755>] } ]
        [0.5 function { FWeave(x,y) }
          color_map {
            [0.00 srgb <0.15, 0.18, 0.265>]
            [0.35 srgb <0.21, 0.265, 0.385>]
            [1.00 srgb <0.39, 0.45, 0.56>] } ]
      }
    }
    finish { diffuse 0.78, 0.30 }
  }
}

// the fringe along the short side
#declare RF = seed(5);
union {
  #local V = CV0 + 0.2;
  #while (V < CV1)
    #local Pa = ClothPos(CU0, V);
    #local Pb = ClothPos(CU0 + 0.6, V);
    #local Dv = vnormalize((Pa - Pb)*<1,0,1>);
    #local Dw = vrotate(Dv, y*(rand(RF)*50 - 25));
    #local Dx = vrotate(Dw, y*(rand(RF)*70 - 35));
    #local L = 0.55 + 0.25*rand(RF);
    sphere_sweep { b_spline 6,
      Pa - Dv*0.5, 0.085, Pa, 0.085, Pa*<1,0.6,1> + y*0.06 + Dv*L, 0.075, Pa*<1,0.2,1> + y*0.09 + Dv*L + Dw*L, 0.065
      Pa*<1,0.05,1> + y*0.08 + Dv*L + Dw*L + Dx*L, 0.05, Pa*<1,0,1> + y*0.07 + Dv*L + Dw*L + Dx*L*2, 0.03 }
    #local V = V + 0.26 + 0.1*rand(RF);
  #end
  pigment { bozo color_map { [0.3 srgb <0.72,0.69,0.62>] [0.7 srgb <0.84,0.81,0.755>] } scale 0.3 }
}

// ------------------------------------------------------------------ half an orange
#declare FAng = function(x,z) { atan2(z, x)/(2*pi)*10 + 10.3 + 0.25*(f_noise3d(x*1.3, 1, z*1.3) - 0.5) }
#declare FSeg = function(x,z) { abs(mod(FAng(x,z), 1) - 0.5) }    // 0.5 on a membrane
#declare FJuice = function(x,z) {    // little sacs, stretched towards the rind
  f_noise3d(22*atan2(z,x), 4*sqrt(x*x+z*z), 3)*0.55 + f_noise3d(x*9, 2, z*9)*0.45
}
#declare FCut = function(x,z) {      // 0 flesh .. 1 membrane or pith .. 2 rind
  select(sqrt(x*x+z*z) - 0.965,
    max(SStep(0.845, 0.90, sqrt(x*x+z*z) + 0.055*SStep(0.22,0.5,FSeg(x,z)) + 0.03*(f_noise3d(x*4,8,z*4)-0.5)),
      max(1 - SStep(0.04, 0.09, sqrt(x*x+z*z) + 0.05*f_noise3d(x*9,4,z*9)),
          0.62*SStep(0.030, 0.006, (0.5-FSeg(x,z))*sqrt(x*x+z*z)*0.63))),
    2)
}
#declare HalfOrange = union {
  difference {
    object { Rev(OrangeSpl, NR, NR*2, 0.004, 0.012, 4.4, 0) }
    plane { -y, 0 }
    texture {
      pigment { function { min(0.999, 0.25 + 0.6*f_noise3d(1.7*x, 1.7*y, 1.7*z)) }
        color_map { [0.2 srgb <0.90, 0.50, 0.09>] [0.8 srgb <0.85, 0.35, 0.06>] } }
      normal { crackle 0.8 form <1,0,0> scale 0.062 slope_map { [0 <0,1>] [0.25 <0.6,1>] [0.5 <1,0>] [1 <1,0>] } }
      finish { diffuse 0.75 specular 0.17 roughness 0.03 reflection { 0.01, 0.25 fresnel on } conserve_energy }
    }
  }
  disc { y*0.002, y, 0.998
    texture {
      pigment {
        function { FCut(x,z)/2.001 }
        pigment_map {
          [0.00 function { FJuice(x,z) }
            color_map {
              [0.22 srgb <0.80, 0.36, 0.05>]
              [0.42 srgb <0.88, 0.46, 0.085>]
              [0.62 srgb <0.91, 0.54, 0.13>]
              [0.85 srgb <0.94, 0.66, 0.26>] } ]
          [0.50 bozo color_map { [0.3 srgb <0.90, 0.78, 0.55>] [0.7 srgb <0.94, 0.85, 0.66>] } scale 0.1]
          [0.90 srgb <0.93, 0.76, 0.45>]
          [1.00 srgb <0.90, 0.48, 0.08>]
        }
      }
      normal { function { 0.7*FJuice(x,z) + 0.3*min(1,FCut(x,z)) } 0.35 }
      finish { diffuse 0.78 specular 0.35 roughness 0.02 reflection { 0.01, 0.3 fresnel on } conserve_energy }
    }
  }
  interior { ior 1.4 }
}

// ------------------------------------------------------------------ a sprig for the vase
#macro LeafPos(A, B, L, Curl)
  #local Wd = 0.29*pow(sin(pi*pow(min(0.9999,max(0.0001,A)),0.8)), 0.85)*(1 - 0.2*A);
  (<B*Wd, 0.35*abs(B)*Wd + Curl*(A*A - 0.25*A) + 0.03*sin(A*8 + Curl*20), A>*L)
#end
#macro Leaf(L, Curl, Hue)   // along +z, face up
  #local NL = 12;
  #local LP = array[NL+1][7];
  #local LN = array[NL+1][7];
  #local I = 0;
  #while (I <= NL)
    #local J = 0;
    #while (J < 7)
      #local A = I/NL; #local B = (J-3)/3;
      #local LP[I][J] = LeafPos(A, B, L, Curl);
      #local Am = min(0.97, max(0.03, A)); #local Bm = B*0.9 + 0.02;
      #local LN[I][J] = vnormalize(vcross(LeafPos(Am+0.02,Bm,L,Curl) - LeafPos(Am-0.02,Bm,L,Curl),
                                          LeafPos(Am,Bm+0.06,L,Curl) - LeafPos(Am,Bm-0.06,L,Curl)));
      #local J = J + 1;
    #end
    #local I = I + 1;
  #end
  mesh {
    #local I = 0;
    #while (I < NL)
      #local J = 0;
      #while (J < 6)
        smooth_triangle { LP[I][J],LN[I][J], LP[I+1][J],LN[I+1][J], LP[I+1][J+1],LN[I+1][J+1] }
        smooth_triangle { LP[I][J],LN[I][J], LP[I+1][J+1],LN[I+1][J+1], LP[I][J+1],LN[I][J+1] }
        #local J = J + 1;
      #end
      #local I = I + 1;
    #end
    texture {
      pigment {
        function { min(0.999, max(0, Hue + 0.5*(f_noise3d(x*1.6,y*1.6,z*1.6)-0.5) - 0.35*exp(-abs(x)*26)
           - 0.10*SStep(0.75,1,abs(sin((z - abs(x)*0.7)*9))))) }
        color_map { [0.0 srgb <0.53, 0.57, 0.40>] [0.4 srgb <0.36, 0.43, 0.29>] [1.0 srgb <0.24, 0.32, 0.215>] }
      }
      finish { diffuse 0.62, 0.30 specular 0.16 roughness 0.06 }
    }
  }
#end
#macro Sprig(Sp, N, Sd, L0)   // Sp(0..1): the twig
  #declare RT = seed(Sd);
  sphere_sweep { b_spline 13
    #local I = -1;
    #while (I < 12)
      , Sp(I/11), 0.17 - 0.010*I
      #local I = I + 1;
    #end
    texture { pigment { bozo color_map { [0.3 srgb <0.27,0.20,0.13>] [0.7 srgb <0.40,0.33,0.20>] } scale 0.4 } }
  }
  #local I = 0;
  #while (I < N)
    #local T = 0.28 + 0.72*I/N;
    #local Q = Sp(T);
    #local Dv = vnormalize(Sp(T+0.02) - Sp(T-0.02));
    #local Yaw = I*137 + rand(RT)*40;
    #local Ax = vnormalize(vcross(Dv, <0.3, 0.2, 1>));
    #local Sd2 = vaxis_rotate(Ax, Dv, Yaw);
    #local Zd = vnormalize(Sd2*(0.75 + 0.3*rand(RT)) + Dv*0.65 - y*0.12);
    #local Yd = vnormalize(Dv - Zd*vdot(Dv,Zd) + y*0.25);
    #local Xd = vnormalize(vcross(Yd, Zd));
    #local Yd = vcross(Zd, Xd);
    object { Leaf(L0*(1.1 - 0.5*T)*(0.8 + 0.4*rand(RT)), -0.25 + 0.3*rand(RT), 0.15 + 0.7*rand(RT))
      matrix <Xd.x,Xd.y,Xd.z, Yd.x,Yd.y,Yd.z, Zd.x,Zd.y,Zd.z, Q.x,Q.y,Q.z> }
    #local I = I + 1;
  #end
#end
#declare Twig1 = spline { natural_spline
  -0.1, <0.2, 12, 0>, 0.00, <0.3, 15, -0.3>, 0.3, <1.4, 21.5, -0.8>, 0.6, <4.6, 27.0, -1.4>, 0.85, <9.0, 29.8, -2.2>, 1.1, <14.2, 30.2, -3.0> }
#declare Twig2 = spline { natural_spline
  -0.1, <-0.2, 12, 0>, 0.00, <-0.3, 15, 0.3>, 0.3, <-0.9, 21.5, 0.9>, 0.6, <-2.4, 26.0, 1.6>, 0.85, <-4.9, 29.0, 2.0>, 1.1, <-8.3, 30.6, 2.2> }
#declare Twig3 = spline { natural_spline
  -0.1, <0.0, 12, 0>, 0.00, <0.0, 15, 0.5>, 0.3, <0.4, 21.5, 1.4>, 0.6, <1.0, 26.5, 2.6>, 0.85, <1.3, 30.5, 3.2>, 1.1, <1.2, 34.0, 3.6> }

// ------------------------------------------------------------------ glass of water
#declare GlassMat = material {
  texture {
    pigment { srgbt <0.95, 0.985, 0.97, 1> }
    finish { diffuse 0 specular 0.4 roughness 0.004 reflection { 0.0, 1 fresnel on } conserve_energy }
  }
  interior { ior 1.5 caustics 0.6 fade_color srgb <0.80,0.93,0.88> fade_distance 6 fade_power 1001 }
}
#declare Tumbler = union {
  difference {
    cone { 0, 2.9, y*10.4, 3.75 }
    cone { y*1.1, 2.65, y*10.6, 3.60 }
    material { GlassMat }
  }
  torus { 3.67, 0.075 translate y*10.4 material { GlassMat } }
  cone { y*1.05, 2.70, y*6.6, 3.25
    texture { pigment { rgbt <1,1,1,1> } finish { diffuse 0 specular 0.3 roughness 0.005 reflection { 0, 1 fresnel on } conserve_energy } }
    interior { ior 1.33 caustics 0.5 }
  }
}

// ------------------------------------------------------------------ the arrangement
#declare VaseAt = <-13.4, 0, 6>;
object { Vase scale 0.80 rotate y*40 translate VaseAt }
union { Sprig(Twig1, 19, 11, 5.2) Sprig(Twig2, 15, 25, 5.0) Sprig(Twig3, 15, 38, 4.8) translate VaseAt }

#declare BowlAt = <8.0, 0.2, 4.0>;
object { Bowl translate BowlAt }
object { Orange(1.3, 0.55) scale 3.9  rotate <-45, 40, 25>   translate BowlAt + <-5.2, 7.0, -2.6> }
object { Orange(2.1, 0.70) scale 3.75 rotate <20, 140, -70>  translate BowlAt + <-2.2, 7.0, 5.2> }
object { Orange(3.7, 0.45) scale 3.8  rotate <-60, 200, 0>   translate BowlAt + <5.4, 7.0, 2.8> }
object { Apple(4.2, 0.05, -0.6, -0.8, 0.7) scale 3.75 rotate <-24, 60, -16> translate BowlAt + <2.4, 7.3, -4.6> }
object { Pear(1.4, 0.30, 0.8, -0.5, 0.05, 0.8) scale 3.3 rotate <6, 20, -24> translate BowlAt + <-0.4, 12.3, 1.2> }

object { Apple(1.1, 0.16, 0.5, -0.6, -0.6) scale 3.95 rotate <-15, 0, 9> translate <-6.3, 3.36, -10.0> }
object { Apple(2.6, -0.16, 0.9, -0.2, 0.8) scale 3.7 rotate <-6, 130, -5> translate <-14.6, 3.0, -6.0> }
object { Pear(3.3, 0.36, 0.9, -0.3, -0.06, -0.7) scale 3.25 rotate <0, 60, 0> translate <-0.2, 3.2, -7.0> }
object { HalfOrange scale 3.7 rotate y*35 rotate x*-58 rotate y*-12 translate <2.3, 2.9, -13.4> }
GrapePile(13.8, -9.8, 7.2, 4.6, -14, 46, 0.2, 77)
object { Tumbler translate <24.6, 0.2, 9.5> }

// the grapes' stalk, a few strays and a fallen leaf
sphere_sweep { b_spline 8,
  <14.5, 3.2, -9.2>, 0.20, <15.8, 4.8, -9.4>, 0.19, <17.4, 5.9, -9.5>, 0.17, <19.2, 6.5, -9.3>, 0.16
  <20.9, 6.5, -9.0>, 0.18, <22.2, 6.1, -8.9>, 0.24, <23.0, 5.8, -8.9>, 0.28, <23.6, 5.6, -8.9>, 0.2
  pigment { bozo color_map { [0.3 srgb <0.36,0.34,0.16>] [0.7 srgb <0.46,0.35,0.19>] } scale 0.5 }
  normal { bumps 0.4 scale 0.15 }
}
Grape(<-17.2, 1.0, -17.5>, 1.02, 3.3, 0.35)
Grape(<-14.6, 0.95, -18.9>, 0.97, 8.1, 0.6)
object { Leaf(5.6, -0.16, 0.35) rotate <4, 62, 8> translate <-25.5, 0.35, -15.0> }

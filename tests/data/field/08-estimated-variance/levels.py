# Rates at which correct renderers pass, fail and stay inconclusive, by distribution, passes and ground (NumPy).
# usage: levels.py TRUEFLIGHT STACKS SEED LAW...   laws: normal, const, rareP (hit with probability P), lnS (log-normal of sigma S)
import numpy as np, subprocess, sys, os, json, tempfile
TF=os.path.abspath(sys.argv[1]); reps=int(sys.argv[2]); seed=int(sys.argv[3]); laws=sys.argv[4:]
rng=np.random.default_rng(seed)
S=24
tr=0.2+0.05*np.tile(np.arange(S),(S,1))
def law(k,n,c=1,factor=None):
    sh=(n,S,S)
    def one():
        if k=='normal': return 1+0.5*rng.standard_normal(sh)
        if k=='const': return 1+0.01*rng.standard_normal(sh)
        if k.startswith('rare'): p=float(k[4:]); return (rng.random(sh)<p)/p
        s=float(k[2:]); return (rng.random(sh)<.5)*2*rng.lognormal(-.5*s*s,s,sh)
    x=sum(one() for _ in range(c))/c*tr
    return x if factor is None else x*factor
d=tempfile.mkdtemp(); os.chdir(d)
def run(*a):
    r=subprocess.run([TF,'judge','--images','--format','json',*a],capture_output=True,text=True)
    if r.returncode==2: return 3, {}
    return r.returncode, json.loads(r.stdout)
np.save('t.npy',tr)
for k in laws:
    for n,q in [(2,2),(4,16),(16,4),(16,16),(64,64)]:
        c={}
        for r in range(reps):
            x=law(k,n);z=law(k,q);
            np.save('x.npy',x.astype('f4'));np.save('z.npy',z.astype('f4'));np.save('v.npy',z.var(0,ddof=1));np.save('m.npy',z.mean(0))
            for name,a in dict(image=['--truth-image','t.npy','--variance-image','v.npy','--variance-passes',str(q)],
                 stack=['--truth-image','t.npy','--variance-stack','z.npy'],
                 truth=['--truth-image','m.npy','--truth-passes',str(q),'--variance-image','v.npy','--variance-passes',str(q)],
                 against=['--against','z.npy'], same=['--against','z.npy','--same-distribution']).items():
                rc,j=run(*a,'x.npy'); e=c.setdefault(name,[0,0,0]); e[{0:0,1:1,3:2}[rc]]+=1
                if rc==1: print('FAIL',k,n,q,name,j['reason'][:200],flush=True)
        print(k,n,q,'pass/fail/inc',c,flush=True)
